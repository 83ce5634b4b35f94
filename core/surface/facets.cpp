#include "core/surface/facets.h"

#include <cstddef>

namespace ctpm::surface {
namespace {

/// Normals of a facet's vertices make at most 60 degrees with that of the first one.
constexpr double kSameWay = 0.5;

}  // namespace

Facets::Facets(const Surface& surface, double radius) {
  find_corners(surface);
  const std::size_t count = surface.vertex.size();
  std::vector<Vec3> normals(count);
  const auto place = [&](Index vertex) { return surface.vertex[std::size_t(vertex)]; };
  for (std::size_t v = 0; v < count; ++v) normals[v] = normal(Index(v), place);
  facet_.assign(count, -1);
  for (std::size_t v = 0; v < count; ++v)
    if (facet_[v] < 0) grow(Index(v), radius, surface, normals);
}

void Facets::find_corners(const Surface& surface) {
  const std::size_t count = surface.vertex.size();
  first_.assign(count + 1, 0), area_.assign(count, 0);
  for (const auto& t : surface.triangle) {
    const Vec3 a = surface.vertex[std::size_t(t[0])], b = surface.vertex[std::size_t(t[1])],
               c = surface.vertex[std::size_t(t[2])];
    const double third = norm(cross(b - a, c - a)) / 6;
    for (const Index corner : t) ++first_[std::size_t(corner) + 1], area_[std::size_t(corner)] += third;
  }
  for (std::size_t v = 0; v < count; ++v) first_[v + 1] += first_[v];
  corners_.resize(std::size_t(first_[count]));
  std::vector<Index> next(first_.begin(), first_.end() - 1);
  for (const auto& t : surface.triangle)
    for (std::size_t c = 0; c < 3; ++c)
      corners_[std::size_t(next[std::size_t(t[c])]++)] = {t[(c + 1) % 3], t[(c + 2) % 3]};
}

/// Adds to the facet of `seed` what can be reached from it over vertices that belong to it.
void Facets::grow(Index seed, double radius, const Surface& surface, const std::vector<Vec3>& normals) {
  std::vector<Index> found{seed};
  facet_[std::size_t(seed)] = seed;
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const Corners& corners : around(found[i]))
      for (const Index vertex : {corners.next, corners.last}) {
        const auto v = std::size_t(vertex);
        if (facet_[v] >= 0 || norm(surface.vertex[v] - surface.vertex[std::size_t(seed)]) > radius ||
            dot(normals[v], normals[std::size_t(seed)]) < kSameWay)
          continue;
        facet_[v] = seed;
        found.push_back(vertex);
      }
}

}  // namespace ctpm::surface
