#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/organ.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// A surface divided into facets: connected vertices near each other that face about the same way. The spheres do not
/// resolve a pressure within a facet, so that one contact stands for all of it.
class Facets {
 public:
  using Index = std::int32_t;

  /// A facet's vertices lie within `radius` [m] of its first one.
  Facets(const Surface& surface, double radius);

  /// The first vertex of the facet of a vertex.
  Index facet_of(Index vertex) const { return facet_[std::size_t(vertex)]; }

  /// Area that a vertex stands for at rest [m^2]: a third of its triangles'. The areas sum to that of the surface.
  double area(Index vertex) const { return area_[std::size_t(vertex)]; }

  /// Outward normal at a vertex [1], weighted with the areas of its triangles; 0 where these cancel. `place(vertex)`
  /// gives positions [m].
  template <class Place>
  Vec3 normal(Index vertex, const Place& place) const {
    const Vec3 at = place(vertex);
    Vec3 sum;
    for (const auto& [next, last] : around(vertex)) sum += cross(place(next) - at, place(last) - at);
    const double size = norm(sum);
    return size > 0 ? sum / size : Vec3{};
  }

 private:
  /// The other two corners of a triangle, in its order.
  struct Corners {
    Index next, last;
  };
  std::span<const Corners> around(Index vertex) const {
    const auto begin = std::size_t(first_[std::size_t(vertex)]);
    return std::span(corners_).subspan(begin, std::size_t(first_[std::size_t(vertex) + 1]) - begin);
  }
  void find_corners(const Surface& surface);
  void grow(Index seed, double radius, const Surface& surface, const std::vector<Vec3>& normals);

  std::vector<Index> first_;  ///< where a vertex's entries in corners_ begin (vertex_count + 1)
  std::vector<Corners> corners_;
  std::vector<double> area_;  ///< (vertex_count)
  std::vector<Index> facet_;  ///< (vertex_count)
};

}  // namespace ctpm::surface
