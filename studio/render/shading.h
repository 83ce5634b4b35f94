#pragma once

#include <vector>

#include "core/model/organ.h"

namespace ctpm::render {

/// What a surface's light depends on besides its place.
struct Shading {
  std::vector<Vec3> normal;  ///< unit: sums over the triangles at a vertex, weighted by their area (vertex_count)
  /// Height of the neighbours below the tangent plane over their distance: negative in hollows, positive on ridges
  /// (vertex_count)
  std::vector<float> crevice;
};

/// Replaces the normals of a surface whose vertices are at `position`.
void find_normals(const Surface& surface, const std::vector<Vec3>& position, Shading& shading);

/// Replaces the crevices, which go by the normals. `per_neighbour`: from count_neighbours().
void find_crevices(const Surface& surface, const std::vector<Vec3>& position, const std::vector<float>& per_neighbour,
                   Shading& shading);

/// One over the number of triangles at each vertex                                                       (vertex_count)
std::vector<float> count_neighbours(const Surface& surface);

}  // namespace ctpm::render
