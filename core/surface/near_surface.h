#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// A point on the surface as a weighted sum of spheres: its position is the sum of `weight` times sphere position.
struct Follower {
  std::span<const std::int32_t> sphere;  ///< of the Model
  std::span<const double> weight;        ///< sum to 1

  /// The weighted sum of a quantity of the spheres.
  Vec3 of(const Vec3Array& values) const {
    Vec3 sum;
    for (std::size_t i = 0; i < sphere.size(); ++i) sum += weight[i] * values[std::size_t(sphere[i])];
    return sum;
  }
};

/// The surfaces of all organs of a Model as one, and which part of it is near a ball. Vertices are numbered through all
/// organs. Only near parts are computed: triangles form patches, patches form groups, and each is bounded by
/// how far the spheres that it follows have moved.
class NearSurface {
 public:
  using Index = std::int32_t;

  struct Triangle {
    Index corner[3];
    double rest_area;     ///< [m^2]
    double longest_edge;  ///< at rest [m]
  };

  /// `model` must outlive the NearSurface. Builds nothing unless `is_wanted`.
  NearSurface(const Model& model, bool is_wanted);

  bool empty() const { return triangles_.empty(); }
  std::size_t vertex_count() const { return first_.empty() ? 0 : first_.size() - 1; }
  Follower follower(Index vertex) const {
    const auto begin = std::size_t(first_[std::size_t(vertex)]),
               count = std::size_t(first_[std::size_t(vertex) + 1]) - begin;
    return {std::span(sphere_).subspan(begin, count), std::span(weight_).subspan(begin, count)};
  }
  Vec3 rest(Index vertex) const { return rest_[std::size_t(vertex)]; }

  /// Calls `visit(triangle, corners)` for every triangle whose patch may come within `radius` [m] of `centre`, with the
  /// positions of its corners, in a fixed order.
  template <class Visit>
  void near(const Vec3Array& position, Vec3 centre, double radius, Visit&& visit);

 private:
  /// A run of triangles or of patches, and the spheres that they follow.
  struct Bound {
    Index first, last;                ///< triangles, or patches
    Index first_sphere, last_sphere;  ///< in bound_spheres_
    Vec3 least, most;                 ///< box of the vertices at rest [m]
    /// A vertex moves by a weighted sum of the spheres' displacements, with weights that sum to 1. It lies within their
    /// range, widened on each side by this part of it: the largest sum of negative weights.
    double widen;
  };

  void add_organ(const Surface& surface, const OrganRange& organ);
  void sort_triangles();
  Bound bound_of(Index first, Index last, Index first_triangle, Index last_triangle);
  bool is_near(const Bound& bound, const Vec3Array& position, Vec3 centre, double radius) const;
  Vec3 place(Index vertex, const Vec3Array& position);

  const Vec3Array& sphere_rest_;
  std::vector<Index> first_, sphere_;  ///< binding of all vertices, as in SurfaceBinding
  std::vector<double> weight_;
  std::vector<Vec3> rest_;           ///< [m]
  std::vector<Triangle> triangles_;  ///< by patch
  std::vector<Bound> patches_, groups_;
  std::vector<Index> bound_spheres_;
  std::vector<Vec3> placed_;              ///< positions of the vertices that the present call placed [m]
  std::vector<std::uint32_t> placed_in_;  ///< call that placed a vertex
  std::uint32_t call_ = 0;
};

template <class Visit>
void NearSurface::near(const Vec3Array& position, Vec3 centre, double radius, Visit&& visit) {
  ++call_;
  for (const Bound& group : groups_) {
    if (!is_near(group, position, centre, radius)) continue;
    for (Index p = group.first; p < group.last; ++p) {
      const Bound& patch = patches_[std::size_t(p)];
      if (!is_near(patch, position, centre, radius)) continue;
      for (Index t = patch.first; t < patch.last; ++t) {
        const Triangle& triangle = triangles_[std::size_t(t)];
        const Vec3 corners[3] = {place(triangle.corner[0], position), place(triangle.corner[1], position),
                                 place(triangle.corner[2], position)};
        visit(triangle, corners);
      }
    }
  }
}

}  // namespace ctpm::surface
