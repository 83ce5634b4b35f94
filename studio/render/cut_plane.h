#pragma once

#include <optional>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::render {

/// Where the blade passed around a sphere: crossings of the links between what it sees and what it lost, with
/// the direction across.
struct CutPoint {
  Vec3 place, across;  ///< [m], unit vector away from the sphere
};

/// A plane; `point` is on it, `normal` has unit length and points away from the sphere it was fitted for.
struct Plane {
  Vec3 point, normal;
  double height(Vec3 p) const { return dot(p - point, normal); }
};

/// The plane of the crossings near a place; none if there are none. Of all directions that fit them alike, as
/// where they lie on one line, it takes the mean direction across.
std::optional<Plane> fit_plane(const std::vector<CutPoint>& crossings, Vec3 near, double reach);

}  // namespace ctpm::render
