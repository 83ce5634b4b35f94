#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/organ.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// Weights with which one point follows nearby spheres: moving least squares with a linear basis, so every
/// affine motion of the spheres is followed exactly. `radius` [m] is the reach of the smooth kernel; spheres
/// beyond it get nothing. Where the spheres in reach do not span space, the point follows them with kernel
/// weights alone (exact under translation). Returns weights that sum to 1, one per candidate.
std::vector<double> follow_weights(Vec3 point, std::span<const Vec3> candidates, double radius);

/// Binds every vertex of `organ.surface` to the spheres within 2.2 spacings (at least the 8 nearest). The
/// result does not depend on `threads`, >= 1.
void bind_surface(FilledOrgan& organ, int threads = 1);

/// Where the surface's vertices are [m] when the organ's spheres are at `position[first_sphere + ...]`
/// (vertex_count).
void deform_surface(const Surface& surface, const Vec3Array& position, std::int32_t first_sphere,
                    std::vector<Vec3>& vertex);

}  // namespace ctpm::surface
