#include "studio/render/depth_field.h"

#include <algorithm>
#include <cmath>

#include "core/cutting/blade_geometry.h"
#include "studio/render/camera.h"

namespace ctpm::render {
namespace {

constexpr double kMostAlong = 80;       // values along the longest side
constexpr double kRounding = 1 + 1e-9;  // the ball around a triangle is larger by this, so that nothing is lost

double squared(Vec3 v) { return dot(v, v); }

/// Whether a line along z through (x, y) meets a triangle; of two triangles with a common edge it meets one.
bool meets(const std::array<Vec3, 3>& corner, double x, double y) {
  bool is_inside = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &p = corner[i], &q = corner[(i + 1) % 3], &a = p.y < q.y ? p : q, &b = p.y < q.y ? q : p;
    if ((a.y > y) == (b.y > y)) continue;
    is_inside ^= x < a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
  }
  return is_inside;
}

}  // namespace

DepthField::DepthField(const Surface& surface, double reach, double detail) {
  const Bounds box = bounds_of(surface.vertex);
  const Vec3 whole = box.max - box.min;
  const double longest = std::max({whole.x, whole.y, whole.z});
  const double step = std::max(0.4 * detail, longest / kMostAlong);
  reach += 2 * step;
  const auto along = [&](double length) { return int(std::ceil(length / step)) + 2; };
  count = {along(whole.x), along(whole.y), along(whole.z)};
  size = step * Vec3{double(count[0]), double(count[1]), double(count[2])};
  low = box.centre() - 0.5 * size;
  depth.assign(std::size_t(count[0]) * std::size_t(count[1]) * std::size_t(count[2]), float(reach));
  for (const auto& t : surface.triangle) {
    const Vec3 a = surface.vertex[std::size_t(t[0])], b = surface.vertex[std::size_t(t[1])],
               c = surface.vertex[std::size_t(t[2])];
    std::array<int, 3> from, to;
    const auto clip = [&](std::size_t axis, double x, double y, double z, double begin) {
      from[axis] = std::max(0, int((std::min({x, y, z}) - reach - begin) / step));
      to[axis] = std::min(count[axis] - 1, int((std::max({x, y, z}) + reach - begin) / step));
    };
    clip(0, a.x, b.x, c.x, low.x), clip(1, a.y, b.y, c.y, low.y), clip(2, a.z, b.z, c.z, low.z);
    const Vec3 middle = (a + b + c) / 3.0;
    const double radius =
        kRounding * std::sqrt(std::max({squared(a - middle), squared(b - middle), squared(c - middle)}));
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i) {
          const Vec3 place = low + step * Vec3{i + 0.5, j + 0.5, k + 0.5};
          float& least =
              depth[std::size_t(i) + std::size_t(count[0]) * (std::size_t(j) + std::size_t(count[1]) * std::size_t(k))];
          // Mostly a triangle that was looked at before is nearer than the ball around this one.
          if (const double within = double(least) + radius; squared(place - middle) > within * within) continue;
          if (const double square = squared(place - cutting::nearest_in_triangle(place, a, b, c));
              square < double(least) * double(least))
            least = float(std::sqrt(square));
        }
  }
  find_outside(surface, step);
}

/// Makes the values outside negative: where a line along z has left the surface as often as it has entered it.
void DepthField::find_outside(const Surface& surface, double step) {
  std::vector<std::vector<double>> crossed(std::size_t(count[0]) * std::size_t(count[1]));  // [m] along z
  const auto middle = [&](double begin, int i) { return begin + step * (i + 0.5); };
  for (const auto& t : surface.triangle) {
    const std::array<Vec3, 3> corner{surface.vertex[std::size_t(t[0])], surface.vertex[std::size_t(t[1])],
                                     surface.vertex[std::size_t(t[2])]};
    const Vec3 n = cross(corner[1] - corner[0], corner[2] - corner[0]);
    if (n.z == 0) continue;
    const auto [left, right] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
    const auto [front, back] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
    for (int j = int((front - low.y) / step); j <= int((back - low.y) / step); ++j)
      for (int i = int((left - low.x) / step); i <= int((right - low.x) / step); ++i)
        if (const double x = middle(low.x, i), y = middle(low.y, j); meets(corner, x, y))
          crossed[std::size_t(i + count[0] * j)].push_back(corner[0].z -
                                                           (n.x * (x - corner[0].x) + n.y * (y - corner[0].y)) / n.z);
  }
  for (std::size_t column = 0; column < crossed.size(); ++column) {
    std::vector<double>& at = crossed[column];
    if (at.size() % 2 == 1) continue;  // the surface is open there
    std::sort(at.begin(), at.end());
    for (int k = 0; k < count[2]; ++k) {
      const auto below = std::lower_bound(at.begin(), at.end(), middle(low.z, k)) - at.begin();
      if (float& value = depth[column + crossed.size() * std::size_t(k)]; below % 2 == 0) value = -value;
    }
  }
}

}  // namespace ctpm::render
