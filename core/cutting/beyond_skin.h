#pragma once

#include <array>
#include <cstddef>

#include "core/cutting/swept_surface.h"
#include "core/cutting/tissue_depth.h"
#include "core/model/vec3.h"

namespace ctpm::cutting {

/// The lattice covers an organ: some of its spheres and elements lie outside the organ's surface, and belong to the
/// tissue under it. So a cut that reaches the surface goes on outside, as far as a spacing, but not into tissue again.

/// The place that is `reach` [m] from `from`, outside an organ at rest, along `way`; nearer where there is tissue.
Vec3 beyond_skin(const TissueDepth& depth, std::size_t organ, Vec3 from, Vec3 way, double reach);

/// Moves the ends of the parts of a front that are newly swept along the front by `reach` [m], where they are outside.
void go_on_outside(const TissueDepth& depth, std::size_t organ, const NewlySwept& newly,
                   const std::array<bool, kEdgeNodes>& is_outside, double reach, Front& front);

}  // namespace ctpm::cutting
