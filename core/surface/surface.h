#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/organ.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// Weights with which a point follows nearby spheres: moving least squares with a linear basis, so that the point
/// follows every affine motion of the spheres exactly. `radius` [m] is the support of the smooth kernel; spheres beyond
/// it get no weight. If the spheres in the support do not span space, the point follows them with the kernel weights
/// alone (exact under translation); if there are none, it follows the nearest sphere. Returns one weight per candidate;
/// they sum to 1.
std::vector<double> follow_weights(Vec3 point, std::span<const Vec3> candidates, double radius);

/// Binds every vertex of `organ.surface` to the spheres within 2.2 spacings, or to at least the 8 nearest. The result
/// does not depend on `threads`, >= 1.
void bind_surface(FilledOrgan& organ, int threads = 1);

/// Positions of the surface's vertices [m] when the organ's spheres are at `position[first_sphere + ...]`
/// (vertex_count).
void deform_surface(const Surface& surface, const Vec3Array& position, std::int32_t first_sphere,
                    std::vector<Vec3>& vertex);

}  // namespace ctpm::surface
