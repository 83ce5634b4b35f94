#include "studio/render/shading.h"

#include <cmath>

namespace ctpm::render {

void find_normals(const Surface& surface, const std::vector<Vec3>& position, Shading& shading) {
  std::vector<Vec3>& normal = shading.normal;
  normal.assign(position.size(), Vec3{});
  for (const auto& t : surface.triangle) {
    const std::size_t a = std::size_t(t[0]), b = std::size_t(t[1]), c = std::size_t(t[2]);
    const Vec3 n = cross(position[b] - position[a], position[c] - position[a]);
    normal[a] += n, normal[b] += n, normal[c] += n;
  }
  for (Vec3& n : normal) {
    const double length = norm(n);
    n = length > 0 ? n / length : Vec3{0, 0, 1};
  }
}

void find_crevices(const Surface& surface, const std::vector<Vec3>& position, const std::vector<float>& per_neighbour,
                   Shading& shading) {
  std::vector<float>& crevice = shading.crevice;
  crevice.assign(position.size(), 0.0f);
  for (const auto& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = std::size_t(t[i]), b = std::size_t(t[(i + 1) % 3]);
      const Vec3 d = position[b] - position[a];
      const double square = dot(d, d);
      if (square > 0) crevice[a] -= float(dot(d, shading.normal[a]) / std::sqrt(square));
    }
  for (std::size_t v = 0; v < crevice.size(); ++v) crevice[v] *= per_neighbour[v];
}

std::vector<float> count_neighbours(const Surface& surface) {
  std::vector<float> per_neighbour(surface.vertex.size(), 0.0f);
  for (const auto& t : surface.triangle)
    for (const std::int32_t v : t) per_neighbour[std::size_t(v)] += 1;
  for (float& x : per_neighbour) x = x > 0 ? 1 / x : 0;
  return per_neighbour;
}

}  // namespace ctpm::render
