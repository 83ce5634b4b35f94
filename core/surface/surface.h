#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// Reach of a binding's kernel, in spacings. Shorter ones let the lattice be felt, longer ones blur the surface.
inline constexpr double kBindingReach = 2;

/// Length below which a bound surface resolves no pressure, in spacings: the distance l at which Boussinesq's point
/// load on a half space, u = F (1 - nu^2) / (pi E l), moves it as far as the surface moves where the load acts. A
/// property of lattice and kernel: measured at 27 places and three spacings, 0.71 to 0.8.
inline constexpr double kUnresolvedLength = 0.75;

/// Weights with which a point follows nearby spheres: moving least squares with a linear basis, so that the point
/// follows every affine motion of the spheres exactly. `reach` [m] is the support of the smooth kernel; spheres beyond
/// it get next to no weight. `trust`, > 0, multiplies a sphere's kernel: spheres that stand for little tissue
/// are soft and must not lead the surface. If the spheres do not span space, the point follows them with the
/// kernel weights alone (exact under translation). Returns one weight per candidate; they sum to 1.
std::vector<double> follow_weights(Vec3 point, std::span<const Vec3> candidates, std::span<const double> trust,
                                   double reach);

/// Binds every vertex of `organ.surface` to the spheres within reach, or to the 8 nearest. A sphere is trusted as much
/// as the tissue that it stands for (FilledOrgan::shares). The result does not depend on `threads`, >= 1.
void bind_surface(FilledOrgan& organ, int threads = 1);

/// A number for each vertex, the same for vertices in one place that follow the same spheres in the same way, and so
/// are together wherever the tissue goes (vertex_count).
std::vector<std::int32_t> welded(const Surface& surface);

/// Positions of the surface's vertices [m] when the organ's spheres are at `position[first_sphere + ...]`
/// (vertex_count).
void deform_surface(const Surface& surface, const Vec3Array& position, std::int32_t first_sphere,
                    std::vector<Vec3>& vertex);

}  // namespace ctpm::surface
