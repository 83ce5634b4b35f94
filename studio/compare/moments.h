#pragma once

#include <vector>

#include "studio/compare/measures.h"

namespace ctpm::compare {

/// The motion of one stroke at 100 Hz; each point is the mean of its ticks.
struct HandMotion {
  double rate_hz = 0;
  std::vector<Vec3> path;   ///< [m]
  std::vector<Spell> idle;  ///< slower than 5 mm/s for at least 0.3 s; indices into `path`
};
HandMotion hand_motion(const SessionTrack& track, const Spell& stroke);

/// The worst moments of the trainee's session, worst first: forces and depths beyond their limits, stray cuts, which
/// sever elements that the expert left whole, deviations of more than half a sphere spacing from the expert's path, and
/// pauses longer than 1 s and than the expert's longest, unless a session lacks real time.
std::vector<Moment> worst_moments(const Comparison& comparison, const SessionTrack& expert,
                                  const SessionTrack& trainee);

}  // namespace ctpm::compare
