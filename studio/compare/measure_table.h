#pragma once

#include <span>
#include <string>
#include <vector>

#include "studio/compare/measures.h"

// The one table of measures: meaning, unit, direction, source and rounding of each.
namespace ctpm::compare {

extern const Measure kCompletionTime, kPathLength, kEconomy, kSparc, kJerk, kIdle, kPeakForce, kMeanForce,
    kOtherPeakForce, kTimeAbove, kImpulseAbove, kImpulse, kWork, kWorkAbove, kZoneTime, kZoneImpulse, kZoneWork, kDepth,
    kBeyondDamage, kSevered, kSeveredBoth, kSeveredExpert, kSeveredTrainee, kOverlap, kCutMean, kCutHausdorff,
    kCutDepth, kCutAlongBlade, kCutLength, kCutArea, kAlignedMean, kAlignedLargest;

/// All of them, in the order of a report.
std::span<const Measure* const> all_measures();

/// Their keys.
std::vector<std::string> measure_keys();

}  // namespace ctpm::compare
