#pragma once

#include <span>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::compare {

/// A line through points.
using Path = std::vector<Vec3>;

/// Points along the path at most `spacing` apart, its own points among them.
Path with_points_every(std::span<const Vec3> path, double spacing);

/// Distance of a point from the nearest of some paths; infinity if there are none.
double distance_from(Vec3 point, std::span<const Path> paths);

/// How far two sets of paths are apart, in their unit.
struct PathDistance {
  double mean = 0;       ///< over points of both, of the distance from the other: average symmetric distance
  double hausdorff = 0;  ///< the farthest that any point of one is from the other
};

/// Compares points every `spacing` along both; neither may be empty. Hausdorff: Huttenlocher et al. 1993;
/// average symmetric distance: Heimann et al. 2009.
PathDistance distance_between(std::span<const Path> a, std::span<const Path> b, double spacing);

}  // namespace ctpm::compare
