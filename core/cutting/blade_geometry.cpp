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
  if ((side_p > 0) == (side_q > 0)) return std::nullopt;
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

// By Voronoi regions (Ericson, "Real-Time Collision Detection", 2005).
Vec3 nearest_in_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return sum > 0 ? a + vb / sum * ab + vc / sum * ac : a;
}

}  // namespace ctpm::cutting
