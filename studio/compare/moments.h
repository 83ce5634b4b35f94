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

/// Why something should be done better, the gravest reason first.
enum class Concern {
  forbidden,  ///< the tool was where the scene forbids it
  undone,     ///< not half of what the expert cut is cut: whatever else was wrong is of another stroke
  harm,       ///< to the tissue: cut where the expert did not, pressed too hard or too deep
  accuracy,   ///< off the expert's path, less deep, not complete
  economy,    ///< time
  trifle,     ///< less than 5 % beyond a limit, or beyond it for a few ticks; few elements beside the expert's cut
};
Concern concern_of(const Moment& moment);

/// The worst moments of the trainee's session: time in forbidden zones; stray cuts, which sever elements that the
/// expert left whole; forces and depths beyond their limits; touching or cutting more than half a sphere spacing
/// away from the expert's path, because the way to the work and back harms nothing (where the expert does neither, all
/// of the way counts); pauses from the first motion to the last touch or cut that are longer than 1 s and than
/// the expert's longest, unless a session lacks real time. They are in the order of their Concern, then of
/// severity, and after three of a kind all others have their turn.
std::vector<Moment> worst_moments(const Comparison& comparison, const SessionTrack& expert,
                                  const SessionTrack& trainee);

}  // namespace ctpm::compare
