#pragma once

#include <span>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::compare {

/// A polyline.
using Path = std::vector<Vec3>;

/// Resamples the path: its own points, and points between them, at most `spacing` apart.
Path with_points_every(std::span<const Vec3> path, double spacing);

/// Distance of a point from the nearest of the paths; infinity if there are none.
double distance_from(Vec3 point, std::span<const Path> paths);

/// Distances between two sets of paths, in their unit.
struct PathDistance {
  double mean = 0;       ///< average symmetric distance: the mean over the points of both of the distance to the other
  double hausdorff = 0;  ///< the largest distance of any point of one from the other
};

/// Compares points every `spacing` along both; neither may be empty. Hausdorff: Huttenlocher et al. 1993;
/// average symmetric distance: Heimann et al. 2009.
PathDistance distance_between(std::span<const Path> a, std::span<const Path> b, double spacing);

}  // namespace ctpm::compare
