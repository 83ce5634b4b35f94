#include "importers/make_organs/solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ctpm::importers {

namespace {

Vec3 divide(Vec3 a, Vec3 b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }

double power_sum(Vec3 v, double exponent) {
  return std::pow(v.x, exponent) + std::pow(v.y, exponent) + std::pow(v.z, exponent);
}

struct SineCosine {
  double sine, cosine;
};
SineCosine of_degrees(double degrees) {
  const double radians = degrees * std::numbers::pi / 180.0;
  return {std::sin(radians), std::cos(radians)};
}

}  // namespace

double ellipsoid(Vec3 point, Vec3 centre, Vec3 half) { return blunt_ellipsoid(point, centre, half, 2.0); }

double blunt_ellipsoid(Vec3 point, Vec3 centre, Vec3 half, double exponent) {
  const Vec3 local = divide(point - centre, half);
  const Vec3 size{std::abs(local.x), std::abs(local.y), std::abs(local.z)};
  const double level = std::pow(power_sum(size, exponent), 1.0 / exponent);
  // At the centre the gradient is undefined; the smallest half axis is the distance there.
  if (level < 1e-9) return -std::min({half.x, half.y, half.z});
  const auto slope = [&](double part, double axis) { return std::pow(part / level, exponent - 1.0) / axis; };
  return (level - 1.0) / norm({slope(size.x, half.x), slope(size.y, half.y), slope(size.z, half.z)});
}

double tapered_capsule(Vec3 point, Vec3 a, double radius_a, Vec3 b, double radius_b) {
  const Vec3 axis = b - a;
  const double along = std::clamp(dot(point - a, axis) / dot(axis, axis), 0.0, 1.0);
  return norm(point - (a + along * axis)) - (radius_a + along * (radius_b - radius_a));
}

double rounded_box(Vec3 point, Vec3 half, double radius) {
  const Vec3 over{std::abs(point.x) - half.x + radius, std::abs(point.y) - half.y + radius,
                  std::abs(point.z) - half.z + radius};
  const Vec3 outside{std::max(over.x, 0.0), std::max(over.y, 0.0), std::max(over.z, 0.0)};
  return norm(outside) + std::min(std::max({over.x, over.y, over.z}), 0.0) - radius;
}

double join(double a, double b, double blend) {
  const double overlap = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - overlap * overlap * overlap * blend / 6.0;
}

double common(double a, double b, double blend) { return -join(-a, -b, blend); }

double cut_out(double solid, double hole, double blend) { return common(solid, -hole, blend); }

Vec3 turn_x(Vec3 v, double degrees) {
  const auto [s, c] = of_degrees(degrees);
  return {v.x, c * v.y - s * v.z, s * v.y + c * v.z};
}

Vec3 turn_y(Vec3 v, double degrees) {
  const auto [s, c] = of_degrees(degrees);
  return {c * v.x + s * v.z, v.y, -s * v.x + c * v.z};
}

Vec3 turn_z(Vec3 v, double degrees) {
  const auto [s, c] = of_degrees(degrees);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

}  // namespace ctpm::importers
