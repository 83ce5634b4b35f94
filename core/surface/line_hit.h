#pragma once

#include <optional>

#include "core/model/vec3.h"

namespace ctpm::surface {

/// Where a line meets a triangle.
struct LineHit {
  double distance;  ///< along the line [m]
  double at[3];     ///< barycentric coordinates [1]
  bool is_exit;     ///< the line comes from behind the triangle
};

/// Where the line from `from` [m] along the unit vector `way` meets a triangle within `reach` [m] (Moller & Trumbore,
/// "Fast, minimum storage ray/triangle intersection", 1997).
inline std::optional<LineHit> meet_line(Vec3 from, Vec3 way, double reach, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, p = cross(way, ac);
  const double facing = dot(ab, p);
  if (facing == 0) return std::nullopt;
  const Vec3 t = from - a, q = cross(t, ab);
  const double v = dot(t, p) / facing, w = dot(way, q) / facing, distance = dot(ac, q) / facing;
  if (v < 0 || w < 0 || v + w > 1 || distance <= 0 || distance > reach) return std::nullopt;
  return LineHit{distance, {1 - v - w, v, w}, facing < 0};
}

}  // namespace ctpm::surface
