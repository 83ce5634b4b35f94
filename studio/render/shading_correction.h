#pragma once

#include <cstddef>
#include <vector>

#include "core/model/organ.h"
#include "studio/render/shading.h"

namespace ctpm::render {

/// What is added to a vertex of a cut organ so that its shading at rest is that of the organ's own surface, whose
/// triangles are others: along the way to a neighbour, and across it, in parts of the normal.
struct ShadingCorrection {
  std::size_t neighbour = 0;
  double along = 0, across = 0;
  float crevice = 0;
  bool is_copy = false;  ///< the neighbour's normal is taken, since the vertex's own triangles are folded
};
using ShadingCorrections = std::vector<ShadingCorrection>;  ///< of the first vertices; empty without a cut

/// `surface`: at rest. `per_neighbour`: from count_neighbours(). `at_rest`: CutSurface::at_rest().
ShadingCorrections corrections_of(const Surface& surface, const std::vector<float>& per_neighbour,
                                  const Shading& at_rest);

/// Corrects the normals of a surface whose vertices are at `position`.
void correct(const ShadingCorrections& corrections, const std::vector<Vec3>& position, std::vector<Vec3>& normals);

}  // namespace ctpm::render
