#include "core/contact/drawn_dent.h"

#include <algorithm>
#include <cmath>

namespace ctpm::contact {
namespace {

/// The funnel leaves the ball here, below its middle, in radii: where the ball is as steep as the funnel.
constexpr double kLeavesBall = 0.70710678118654752;
/// The funnel goes over into the surface around it within this part of its height.
constexpr double kRounded = 0.5;
/// The funnel takes what is as high above the ball's middle as the deepest dent is deep, and nothing so many times as
/// high: that is other tissue, which leans over.
constexpr double kOther = 1.5;

/// Normals of the vertices of triangles with touched ones: sums over those triangles, weighted by area.
std::vector<Vec3> normals_near(const Surface& surface, const std::vector<char>& is_touched,
                               const std::vector<Vec3>& vertex) {
  std::vector<Vec3> normal(vertex.size());
  for (const auto& t : surface.triangle) {
    const auto a = std::size_t(t[0]), b = std::size_t(t[1]), c = std::size_t(t[2]);
    if (!is_touched[a] && !is_touched[b] && !is_touched[c]) continue;
    const Vec3 n = cross(vertex[b] - vertex[a], vertex[c] - vertex[a]);
    normal[a] += n, normal[b] += n, normal[c] += n;
  }
  return normal;
}

/// How high over the ball's middle the funnel is, so far from its axis [m].
double height_of_funnel(double from_axis, double radius) {
  const double leaves = kLeavesBall * radius;
  return from_axis < leaves ? -std::sqrt(radius * radius - from_axis * from_axis) : from_axis - 2 * leaves;
}

/// The lesser of two heights, rounded where they meet.
double rounded_least(double a, double b, double width) {
  const double near = std::max(0.0, width - std::abs(a - b));
  return std::min(a, b) - (width > 0 ? near * near / (4 * width) : 0.0);
}

}  // namespace

void draw_dent(const Surface& surface, Vec3 centre, double radius, const std::vector<char>& is_touched,
               std::vector<Vec3>& vertex) {
  const std::vector<Vec3> normal = normals_near(surface, is_touched, vertex);
  Vec3 outwards;
  double deepest = 0;
  for (std::size_t v = 0; v < vertex.size(); ++v) {
    const double size = norm(normal[v]);
    if (!is_touched[v] || !(size > 0)) continue;
    outwards += normal[v];
    const Vec3 apart = vertex[v] - centre, outward = normal[v] / size;
    const double height = dot(apart, outward), chord = height * height - dot(apart, apart) + radius * radius;
    if (!(chord > 0)) continue;
    const double dent = std::max(0.0, height + std::sqrt(chord));
    deepest = std::max(deepest, dent), vertex[v] -= dent * outward;
  }
  const double size = norm(outwards);
  if (!(deepest > 0) || !(size > 0)) return;
  const Vec3 axis = outwards / size;
  for (Vec3& p : vertex) {
    const double height = dot(p - centre, axis), above = height + kLeavesBall * radius;
    if (above <= 0 || height >= kOther * deepest) continue;
    const double from_axis = norm(p - centre - height * axis);
    const double to = rounded_least(height, height_of_funnel(from_axis, radius), kRounded * above);
    const double is_beside = std::min(1.0, (kOther - height / deepest) / (kOther - 1));
    p -= is_beside * std::min(height - to, deepest) * axis;
  }
}

}  // namespace ctpm::contact
