#pragma once

#include <optional>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::render {

/// Crossing of one severed link near a sphere: the link joins a sphere that it still sees and one that it lost.
struct CutPoint {
  Vec3 place, across;  ///< rest position [m]; unit vector across the cut, away from the sphere
};

/// A plane through `point` [m]. `normal` has unit length and points away from the sphere for which the plane was
/// fitted.
struct Plane {
  Vec3 point, normal;
  double height(Vec3 p) const { return dot(p - point, normal); }
};

/// Fits a plane to the crossings within `reach` [m] of `near` [m]; none if there are none or if
/// their directions across cancel. Where several normals fit
/// equally well, for example for crossings on one line, the normal is the one nearest to the mean direction across.
std::optional<Plane> fit_plane(const std::vector<CutPoint>& crossings, Vec3 near, double reach);

}  // namespace ctpm::render
