#include "studio/render/depth_field.h"

#include <algorithm>
#include <cmath>

#include "core/cutting/blade_geometry.h"
#include "studio/render/camera.h"

namespace ctpm::render {
namespace {

constexpr double kMostAlong = 160;  // values along the longest side

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
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i) {
          const Vec3 place = low + step * Vec3{i + 0.5, j + 0.5, k + 0.5};
          float& least =
              depth[std::size_t(i) + std::size_t(count[0]) * (std::size_t(j) + std::size_t(count[1]) * std::size_t(k))];
          const Vec3 apart = place - cutting::nearest_in_triangle(place, a, b, c);
          if (const double square = dot(apart, apart); square < double(least) * double(least))
            least = float(std::sqrt(square));
        }
  }
}

}  // namespace ctpm::render
