#pragma once

#include <algorithm>
#include <cmath>

#include "core/model/vec3.h"

// Rotations of devices. The results enter a session as recorded inputs, so they need not be equal on every machine and
// transcendental functions are allowed.
namespace ctpm::sources {

inline double dot(Quat a, Quat b) { return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length_of(Quat q) { return std::sqrt(dot(q, q)); }
inline bool is_finite(Quat q) {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

/// `q` scaled to unit length; its length must not be 0.
inline Quat normalised(Quat q) {
  const double length = length_of(q);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

/// The rotation `b` followed by `a`.
inline Quat product(Quat a, Quat b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// The inverse rotation of `q`, which has unit length.
inline Quat inverse(Quat q) { return {q.w, -q.x, -q.y, -q.z}; }

/// Spherical interpolation along the shortest rotation from `a` (`share` = 0) to `b` (1).
inline Quat turned_towards(Quat a, Quat b, double share) {
  double cosine = dot(a, b);
  if (cosine < 0) b = {-b.w, -b.x, -b.y, -b.z}, cosine = -cosine;
  double from = 1 - share, to = share;
  constexpr double kNearlyEqual = 1 - 1e-9;  // from here on linear interpolation is exact to rounding
  if (cosine < kNearlyEqual) {
    const double angle = std::acos(cosine), sine = std::sin(angle);
    from = std::sin(from * angle) / sine, to = std::sin(to * angle) / sine;
  }
  return normalised({from * a.w + to * b.w, from * a.x + to * b.x, from * a.y + to * b.y, from * a.z + to * b.z});
}

/// The shortest rotation that maps the unit vector `from` to the unit vector `to`.
inline Quat shortest_turn(Vec3 from, Vec3 to) {
  const Vec3 axis = cross(from, to);
  const double w = 1 + dot(from, to);
  if (w > 1e-12) return normalised({w, axis.x, axis.y, axis.z});
  // Opposite vectors: half a turn about any perpendicular axis.
  const Vec3 across = std::abs(from.x) < 0.9 ? cross(from, {1, 0, 0}) : cross(from, {0, 1, 0});
  return normalised({0, across.x, across.y, across.z});
}

/// Angle of the shortest rotation from `a` to `b` [rad], in [0, pi].
inline double angle_between(Quat a, Quat b) { return 2 * std::acos(std::min(1.0, std::abs(dot(a, b)))); }

}  // namespace ctpm::sources
