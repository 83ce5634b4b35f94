#include "importers/wall_thickness.h"

#include <algorithm>
#include <utility>

#include "importers/surface_index.h"

namespace ctpm::importers {
namespace {

constexpr std::size_t kMostPlaces = 500;  // enough for a median

/// As long as twice the triangle's area, outwards.
Vec3 normal_of(const CheckedMesh& mesh, const Triangle& t) {
  const Vec3 a = mesh.vertex[std::size_t(t[0])];
  return cross(mesh.vertex[std::size_t(t[1])] - a, mesh.vertex[std::size_t(t[2])] - a);
}

/// Diameter of the largest ball in the mesh that touches a triangle in its middle [m].
double thickness_at(const CheckedMesh& mesh, const SurfaceIndex& index, const Triangle& triangle, double most) {
  constexpr int kHalvings = 10;
  constexpr double kRounding = 1e-3;
  const Vec3 a = mesh.vertex[std::size_t(triangle[0])], b = mesh.vertex[std::size_t(triangle[1])],
             c = mesh.vertex[std::size_t(triangle[2])], outwards = normal_of(mesh, triangle);
  if (!(norm(outwards) > 0)) return most;
  const Vec3 middle = (a + b + c) / 3, inwards = -1.0 / norm(outwards) * outwards;
  // A ball that fits holds all smaller ones that touch at the same place.
  const auto fits = [&](double radius) {
    const double free = (1 - kRounding) * radius;
    return index.nearest(middle + radius * inwards).squared_distance >= free * free;
  };
  double least = 0, largest = 0.5 * most;
  if (fits(largest)) return most;
  for (int i = 0; i < kHalvings; ++i) {
    const double radius = 0.5 * (least + largest);
    (fits(radius) ? least : largest) = radius;
  }
  return least + largest;
}

}  // namespace

double wall_thickness(const CheckedMesh& mesh, const std::vector<char>& is_marked, double most) {
  std::vector<const Triangle*> marked;
  for (const Triangle& t : mesh.triangle)
    if (std::any_of(t.begin(), t.end(), [&](std::int32_t v) { return is_marked[std::size_t(v)] != 0; }))
      marked.push_back(&t);
  const SurfaceIndex index(mesh.vertex, mesh.triangle);
  std::vector<std::pair<double, double>> places;  // thickness, area
  double area = 0;
  const std::size_t every = 1 + marked.size() / kMostPlaces;
  for (std::size_t i = 0; i < marked.size(); i += every) {
    places.emplace_back(thickness_at(mesh, index, *marked[i], most), norm(normal_of(mesh, *marked[i])));
    area += places.back().second;
  }
  std::sort(places.begin(), places.end());
  for (const auto& [thickness, own] : places)
    if ((area -= 2 * own) <= 0) return thickness;
  return most;
}

}  // namespace ctpm::importers
