#pragma once

#include <span>
#include <string>
#include <vector>

#include "studio/compare/measures.h"

// How much a hand did of what another one did, without which a small force or a short time says nothing of skill.
namespace ctpm::compare {

/// Of the expert's value: what differs by less is as good.
inline constexpr double kNotableShare = 0.1;

/// What the trainee reached less of than the expert, by more than kNotableShare.
struct Shortfall {
  const Measure* measure = nullptr;  ///< kDepth, kCutAlongBlade or kCutArea
  double expert = 0, trainee = 0;    ///< in the measure's unit; trainee: 0 where nothing was pushed or cut
};
/// `damage_depth` [m]: an expert who pushed deeper sets no example; 0: none is known.
std::vector<Shortfall> shortfalls_of(std::span<const MeasuredValue> values, double damage_depth = 0);

/// "depth of the cut along the blade 3 mm of the expert's 8 mm, ..."; empty: none.
std::string to_words(const std::vector<Shortfall>& shortfalls);

}  // namespace ctpm::compare
