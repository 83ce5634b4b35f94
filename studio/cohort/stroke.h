#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/model/vec3.h"
#include "studio/compare/alignment.h"
#include "studio/compare/matched_moments.h"
#include "studio/compare/session_track.h"

namespace ctpm::cohort {

/// Places along a way at which sessions are compared: 0 %, 1 % ... 100 % of its length.
inline constexpr std::size_t kStrokePlaces = 101;

/// What a hand did at each place along the way of another one.
struct StrokeCurve {
  std::vector<Vec3> place;    ///< of the tool [m]                               (kStrokePlaces)
  std::vector<double> force;  ///< largest on the tool from there to the next [N] (kStrokePlaces)
  std::vector<double> time;   ///< of the session, where that force is [s]       (kStrokePlaces)
};

/// `alignment` leads from the reference's way `reference` (a) to that of the session (b).
StrokeCurve stroke_curve(const compare::TimedPath& reference, const compare::Alignment& alignment,
                         const compare::TimedPath& way, const compare::SessionTrack& track);

/// A quantity of several hands along the way.
struct StrokeBand {
  std::vector<double> mean, deviation;  ///< (kStrokePlaces)
  /// What more than this many deviations above the mean is, is outside.
  static constexpr double kOutside = 2;
  double high(std::size_t i) const { return mean[i] + kOutside * deviation[i]; }
};

StrokeBand band_of(const std::vector<std::vector<double>>& curves);

/// The middle of all hands at each place [m].
std::vector<Vec3> middle_of(const std::vector<StrokeCurve>& curves);

/// How far a hand is from that middle at each place [m].
std::vector<double> distance_from(const std::vector<Vec3>& middle, const StrokeCurve& curve);

/// The stretch of the way in which a hand is farthest above the band.
struct StrokeExcess {
  bool any = false;
  std::size_t from = 0, to = 0, worst = 0;    ///< in percent of the way
  double value = 0, mean = 0, deviation = 0;  ///< at the worst place
};

/// Differences up to `rounding`, and by two places along the way, are none.
StrokeExcess excess_of(const std::vector<double>& curve, const StrokeBand& band, double rounding);

}  // namespace ctpm::cohort
