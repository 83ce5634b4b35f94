#pragma once

#include <vector>

#include "studio/compare/measures.h"

namespace ctpm::compare {

/// The motion of one stroke at the pace of a hand: places at 100 Hz, each the mean of its ticks, since what a
/// hand does is slower than 20 Hz and what is faster is noise of a device.
struct HandMotion {
  double rate_hz = 0;
  std::vector<Vec3> path;        ///< [m]
  std::vector<Spell> idle;       ///< where it is slower than 5 mm/s for at least 0.3 s; indices into `path`
  std::vector<Spell> movements;  ///< what lies between, if it lasts as long
};
HandMotion hand_motion(const SessionTrack& track, const Spell& stroke);

/// What went worst in the trainee's session. First what harms the tissue: forces and depths beyond their
/// limits, and cuts through elements that the expert left whole, against the number of those that the expert
/// severed. Then the path farther than half a sphere spacing from the expert's, and pauses longer than the
/// expert's longest (and 1 s). By severity within both.
std::vector<Moment> worst_moments(const Comparison& comparison, const SessionTrack& expert,
                                  const SessionTrack& trainee);

}  // namespace ctpm::compare
