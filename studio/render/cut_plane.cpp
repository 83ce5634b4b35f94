#include "studio/render/cut_plane.h"

#include <array>

namespace ctpm::render {
namespace {

/// Solves m x = b for a symmetric positive definite matrix given as xx, xy, xz, yy, yz, zz.
Vec3 solve(const std::array<double, 6>& m, Vec3 b) {
  const Vec3 r0{m[0], m[1], m[2]}, r1{m[1], m[3], m[4]}, r2{m[2], m[4], m[5]};
  const Vec3 c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
  return (b.x * c0 + b.y * c1 + b.z * c2) / dot(r0, c0);
}

}  // namespace

std::optional<Plane> fit_plane(const std::vector<CutPoint>& crossings, Vec3 near, double reach) {
  constexpr double kPreference = 1e-4;  // weight of the mean direction relative to the fit
  double sum = 0;
  Vec3 middle, across;
  const auto weight = [&](const CutPoint& c) {
    const Vec3 d = c.place - near;
    const double q = dot(d, d) / (reach * reach);
    return q < 1 ? (1 - q) * (1 - q) : 0.0;
  };
  for (const CutPoint& c : crossings)
    if (const double w = weight(c); w > 0) sum += w, middle += w * c.place, across += w * c.across;
  if (sum == 0 || norm(across) < 1e-9 * sum) return std::nullopt;
  middle = middle / sum, across = across / norm(across);
  std::array<double, 6> scatter{};
  for (const CutPoint& c : crossings) {
    const double w = weight(c) / sum;
    if (w == 0) continue;
    const Vec3 d = (c.place - middle) / reach;
    scatter[0] += w * d.x * d.x, scatter[1] += w * d.x * d.y, scatter[2] += w * d.x * d.z;
    scatter[3] += w * d.y * d.y, scatter[4] += w * d.y * d.z, scatter[5] += w * d.z * d.z;
  }
  scatter[0] += kPreference, scatter[3] += kPreference, scatter[5] += kPreference;
  const Vec3 normal = solve(scatter, across);
  return Plane{middle, normal / norm(normal)};
}

}  // namespace ctpm::render
