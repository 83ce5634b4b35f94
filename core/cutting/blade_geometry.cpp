#include "core/cutting/blade_geometry.h"

namespace ctpm::cutting {
namespace {

/// Six times the signed volume of the tetrahedron a b c d.
double volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return dot(b - a, cross(c - a, d - a)); }

/// Where a segment meets a triangle: the position on the segment and the barycentric weights of the corners.
struct TriangleHit {
  double along, a, b, c;
};

std::optional<TriangleHit> meet_triangle(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
  const double side_p = volume(p, a, b, c), side_q = volume(q, a, b, c);
  if ((side_p > 0) == (side_q > 0) && side_p != 0 && side_q != 0) return std::nullopt;
  if (side_p == 0 && side_q == 0) return std::nullopt;
  const double ab = volume(p, q, a, b), bc = volume(p, q, b, c), ca = volume(p, q, c, a);
  const bool meets = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  const double sum = ab + bc + ca;
  if (!meets) return std::nullopt;
  const double along = side_p / (side_p - side_q);
  if (sum == 0) return TriangleHit{along, 1.0 / 3, 1.0 / 3, 1.0 / 3};  // so thin that its area is lost in rounding
  return TriangleHit{along, bc / sum, ca / sum, ab / sum};
}

}  // namespace

std::optional<SweepHit> meet_sweep(Vec3 p, Vec3 q, Vec3 from, Vec3 to, Vec3 from2, Vec3 to2) {
  // Both triangles share the diagonal from2-to, along which across + share = 1 in either.
  if (const auto hit = meet_triangle(p, q, from, to, from2)) return SweepHit{hit->along, hit->b, hit->c};
  if (const auto hit = meet_triangle(p, q, to, to2, from2))
    return SweepHit{hit->along, hit->a + hit->b, hit->b + hit->c};
  return std::nullopt;
}

}  // namespace ctpm::cutting
