#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/model/box.h"
#include "core/model/model.h"
#include "core/model/vec3.h"
#include "core/surface/rigid_motion.h"

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

/// The half of space behind a plane.
struct HalfSpace {
  Vec3 point;   ///< of the plane [m]
  Vec3 normal;  ///< unit vector, away from the half space

  bool meets(const Box& box) const {
    const Vec3 deepest{normal.x > 0 ? box.low.x : box.high.x, normal.y > 0 ? box.low.y : box.high.y,
                       normal.z > 0 ? box.low.z : box.high.z};
    return dot(deepest - point, normal) <= 0;
  }
};

/// The surfaces of organs of a Model as one, and which part of it is near something. Vertices are numbered through
/// these organs. Only near parts are computed: triangles form patches, patches form groups, and each is bounded by
/// how far the spheres that it follows have moved.
class NearSurface {
 public:
  using Index = std::int32_t;
  static constexpr Index kTrianglesPerPatch = 32, kPatchesPerGroup = 8;
  static constexpr Index kTrianglesPerPatchOfPart = 8;  ///< a part is small

  struct Triangle {
    Index corner[3];
    double rest_area;     ///< [m^2]
    double longest_edge;  ///< at rest [m]
  };

  /// A run of triangles (a patch) or of patches (a group), and the spheres that they follow.
  struct Bound {
    Index first, last;                ///< triangles, or patches
    Index first_sphere, last_sphere;  ///< in bound_spheres_
    Box rest;                         ///< of the vertices [m]
    /// A vertex moves by a weighted sum of the spheres' displacements, with weights that sum to 1. It lies within their
    /// range, widened on each side by this part of it: the largest sum of negative weights.
    double widen;
    double turned;  ///< farther by so much because of what turns with spheres [m]
  };

  /// Surfaces of organs [first_organ, last_organ). `model` must outlive the NearSurface.
  NearSurface(const Model& model, std::size_t first_organ, std::size_t last_organ);
  /// Part of the surface of an organ; its cost is that of the spheres that it follows.
  NearSurface(const Model& model, std::size_t organ, const Surface& part);
  NearSurface(NearSurface&&) = default;

  bool empty() const { return triangles_.empty(); }
  std::size_t vertex_count() const { return first_.empty() ? 0 : first_.size() - 1; }
  Follower follower(Index vertex) const {
    const auto begin = std::size_t(first_[std::size_t(vertex)]),
               count = std::size_t(first_[std::size_t(vertex) + 1]) - begin;
    return {sphere_.subspan(begin, count), weight_.subspan(begin, count)};
  }
  Vec3 rest(Index vertex) const { return rest_[std::size_t(vertex)]; }

  const std::vector<Bound>& patches() const { return patches_; }
  const std::vector<Bound>& groups() const { return groups_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< by patch

  /// Box that contains all vertices at rest [m].
  const Box& rest_box() const { return rest_box_; }

  /// Spheres of the Model that bounds are about, ascending: all of whole organs, or those that a part follows.
  std::span<const Index> spheres() const { return spheres_; }

  /// Begins a round with the spheres at `position` [m], or goes on with the last one if none of them has moved. In a
  /// round, each vertex is placed once.
  void begin(const Vec3Array& position);
  /// Number of the round, 0 before the first one.
  std::uint32_t round() const { return round_; }
  /// Displacements from rest within which those of all vertices lie, or those of a patch or group [m].
  const Box& displacements() const;
  Box displacements(const Bound& bound) const;
  /// Those of all vertices while those of the spheres that they follow lie within `range` [m].
  Box displacements_within(const Box& range) const;
  /// Calls `visit(sphere)` for the Model's spheres by which the vertices of a patch or group move, but for what turns.
  template <class Visit>
  void for_each_sphere(const Bound& bound, Visit&& visit) const {
    for (Index s = bound.first_sphere; s < bound.last_sphere; ++s)
      visit(spheres_[std::size_t(bound_spheres_[std::size_t(s)])]);
  }
  /// A vertex moves at most so many times as far as the farthest of its spheres.
  double stretch() const { return 1 + 2 * widen_; }
  double stretch(Index vertex) const { return 1 + 2 * negative_[std::size_t(vertex)]; }
  /// Where a vertex is [m].
  Vec3 place(Index vertex);
  /// What turns with its spheres and is in no weight [m].
  Vec3 offset(Index vertex) const;
  /// It is at most so long, however the spheres turn [m].
  double offset_size(Index vertex) const { return offset_size_.empty() ? 0 : offset_size_[std::size_t(vertex)]; }
  /// While no sphere moves farther than `reach` from where the present round has it [m], the offset moves by no more
  /// than `rate` times as far as the farthest one.
  TurnBound offset_bound(Index vertex) const;
  /// Where a vertex would be without it [m].
  Vec3 carried(Index vertex);
  /// A box that contains a triangle, however the spheres turn [m].
  Box around(const Triangle& triangle);

  /// Calls `visit(triangle, corners)` for every triangle that may meet `region`, and others of its patch, with the
  /// positions of its corners, in a fixed order. `region`: anything with `meets(Box)`.
  template <class Region, class Visit>
  void near(const Region& region, Visit&& visit);
  /// Calls `visit(triangle)` for every triangle of one of the groups whose patch may meet `region`, in the order in
  /// which near() visits one group after another.
  template <class Region, class Visit>
  void near_of_group(const Region& region, std::size_t group, Visit&& visit);

 private:
  /// Where a patch or group is.
  struct Place {
    std::uint32_t round = 0;  ///< in which it was found
    Box box{Vec3{}};          ///< [m]
  };
  /// How a frame has turned, if it was asked for.
  struct Turned {
    std::uint32_t round = 0, bound_round = 0;  ///< in which it was found, and its bound
    std::array<double, 9> moment{};
    Turn turn;
    TurnBound bound;
  };
  Turned& turned(Index frame) const;
  const Box& place_of(const Bound& bound, Place& place) const {
    if (place.round != round_) place = {round_, bound.rest.moved(displacements(bound))};
    return place.box;
  }
  std::span<const TurnedOffset> turned_of(Index vertex) const {
    if (first_turned_.empty()) return {};
    const auto begin = std::size_t(first_turned_[std::size_t(vertex)]);
    return {turned_.data() + begin, std::size_t(first_turned_[std::size_t(vertex) + 1]) - begin};
  }
  void add_turned(const SurfaceBinding& binding, const OrganRange& organ);
  void find_moved() const;
  void add_organ(const Surface& surface);
  void copy_followers(const Surface& surface, const OrganRange& organ);
  void find_places_in_spheres();
  void find_bounds(Index triangles_per_patch);
  void sort_triangles();
  Bound bound_of(Index first, Index last, Index first_triangle, Index last_triangle, std::vector<Index>& seen);

  const Vec3Array& sphere_rest_;
  std::vector<Index> spheres_;         ///< that bounds are about, ascending: all of the organs, or those followed
  std::vector<Index> first_;           ///< binding of all vertices, as in SurfaceBinding
  std::span<const Index> sphere_;      ///< as there; the Model's own where one organ is all that there is
  std::span<const double> weight_;     ///< as there
  std::span<const Index> in_spheres_;  ///< place of each of sphere_ in spheres_
  std::span<const Vec3> rest_;         ///< of all vertices [m]
  std::vector<TurnedOffset> turned_;   ///< ascending by vertex
  std::vector<Index> first_turned_;    ///< of each vertex, and their number; empty if no vertex has any
  std::vector<double> offset_size_;    ///< of each vertex; empty as the last one [m]
  std::vector<TissueFrame> frame_;     ///< their spheres are places in spheres_
  mutable std::vector<Turned> frame_turned_;
  std::vector<Index> own_sphere_, own_in_spheres_;  ///< what the spans show where it is not the Model's
  std::vector<double> own_weight_;
  std::vector<Vec3> own_rest_;
  std::vector<Triangle> triangles_;  ///< by patch
  std::vector<Bound> patches_, groups_;
  std::vector<Place> patch_places_, group_places_;
  std::vector<Index> bound_spheres_;  ///< in spheres_
  std::vector<double> negative_;      ///< minus the sum of a vertex's negative weights
  Box rest_box_{Vec3{}};
  double widen_ = 0, most_turned_ = 0;  ///< the largest of all bounds
  std::vector<Vec3> position_;          ///< of spheres_ in the present round [m]
  mutable std::vector<Vec3> moved_;     ///< how far they are from rest, if bounds were asked for [m]
  mutable Box displacements_{Vec3{}};
  mutable std::uint32_t moved_in_ = 0;     ///< round in which moved_ and displacements_ were found
  std::vector<Vec3> carried_;              ///< where the vertices are that the present round asked for, unturned [m]
  std::vector<std::uint32_t> carried_in_;  ///< round that asked for a vertex
  std::vector<Vec3> placed_;               ///< the same, turned; both are empty if none turns
  std::vector<std::uint32_t> placed_in_;
  std::uint32_t round_ = 0;
};

template <class Region, class Visit>
void NearSurface::near(const Region& region, Visit&& visit) {
  const auto look_at = [&](const Triangle& triangle) {
    if (!offset_size_.empty() && !region.meets(around(triangle))) return;  // to turn costs more
    const Vec3 corners[3] = {place(triangle.corner[0]), place(triangle.corner[1]), place(triangle.corner[2])};
    visit(triangle, corners);
  };
  for (std::size_t group = 0; group < groups_.size(); ++group) near_of_group(region, group, look_at);
}

template <class Region, class Visit>
void NearSurface::near_of_group(const Region& region, std::size_t group, Visit&& visit) {
  const Bound& bound = groups_[group];
  if (!region.meets(bound.rest.moved(displacements())) || !region.meets(place_of(bound, group_places_[group]))) return;
  for (Index p = bound.first; p < bound.last; ++p) {
    const Bound& patch = patches_[std::size_t(p)];
    if (!region.meets(place_of(patch, patch_places_[std::size_t(p)]))) continue;
    for (Index t = patch.first; t < patch.last; ++t) visit(triangles_[std::size_t(t)]);
  }
}

}  // namespace ctpm::surface
