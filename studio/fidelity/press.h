#pragma once

#include <limits>
#include <span>
#include <vector>

#include "studio/fidelity/body.h"

// A rigid ball that presses a body and comes to rest.
namespace ctpm::fidelity {

/// The body at rest under a ball at one depth.
struct PressPoint {
  double depth = 0;   ///< of the ball's lowest point below the untouched surface [m]
  double force = 0;   ///< against the way of the press [N]
  double inside = 0;  ///< how deep the drawn surface lies in the ball [m], 0 if it is outside
  bool rests = true;  ///< false: the body still moved when the waiting ended, or a tick was refused
};

/// Where a ball touches the untouched body, in the body's own frame.
struct PressSite {
  Vec3 place;   ///< on the drawn surface [m]
  Vec3 inward;  ///< way of the press, unit length
};

/// Presses ball `tool` to each depth in turn, ascending, and waits at each until the body rests. The body must be built
/// for Pace::slow. `with_surface` also measures PressPoint::inside.
std::vector<PressPoint> press(const Body& body, std::int32_t tool, const PressSite& site,
                              std::span<const double> depths, bool with_surface = false);

/// Centre of the ball [m], in the world, with its lowest point `depth` below the site.
Vec3 ball_centre(const Body& body, std::int32_t tool, const PressSite& site, double depth);

/// Inputs of a tick with ball `tool` at `centre` [m].
Inputs ball_at(std::int32_t tool, Vec3 centre);

/// Places over one lattice cell: a grid of `count` x `count`, evenly over one spacing about the middle, on the plane
/// z = `height` [m].
std::vector<PressSite> places_over_cell(double spacing, double height, int count);

/// Mean, and deviations from it.
struct Spread {
  double mean = 0, least = 0, most = 0;
  double deviation = 0;  ///< standard deviation over the mean [share]; infinite unless the mean is above 0
  /// Most over least; infinite unless both are above 0, as a place that feels nothing is as bad as can be.
  double ratio() const { return least > 0 ? most / least : std::numeric_limits<double>::infinity(); }
};
Spread spread_of(const std::vector<double>& values);

}  // namespace ctpm::fidelity
