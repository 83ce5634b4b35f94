#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/model/box.h"
#include "core/model/vec3.h"
#include "core/surface/near_surface.h"

namespace ctpm::surface {

/// Where the patches of a NearSurface are, and which patches of two surfaces are near each other. All boxes contain
/// what they bound but are not the smallest that do: what does not meet them need not be placed.
class NearPatches {
 public:
  using Index = NearSurface::Index;

  explicit NearPatches(const NearSurface& surface);

  /// Begins a round, after one of the surface. Boxes follow where they are asked for.
  void begin() { ++round_; }

  /// Vertices of a patch; a vertex of several patches belongs to the first.
  std::span<const Index> vertices(Index patch) const {
    const auto begin = std::size_t(first_vertex_[std::size_t(patch)]);
    return std::span(vertices_).subspan(begin, std::size_t(first_vertex_[std::size_t(patch) + 1]) - begin);
  }

  /// Box that contains all patches [m].
  Box all() const { return surface_.rest_box().moved(surface_.displacements()); }
  /// Box that contains a patch [m].
  const Box& box(Index patch) { return patches_.find(*this, surface_.patches(), patch).box; }
  /// Displacements from rest within which those of a patch's vertices lie [m].
  const Box& displacements(Index patch) { return patches_.find(*this, surface_.patches(), patch).displacements; }
  /// Box that contains a triangle at rest [m].
  const Box& rest_of_triangle(Index triangle) const { return triangle_rest_[std::size_t(triangle)]; }
  /// Calls `visit(triangle)` for the triangles of a patch that at rest meet `region` [m].
  template <class Visit>
  void for_each_triangle(Index patch, const Box& region, Visit&& visit) const;

  /// Calls `visit(patch, other_patch)` for the patches whose boxes are nearer than `reach[patch]` [m], in a fixed
  /// order.
  template <class Visit>
  void for_each_near(NearPatches& other, const std::vector<double>& reach, Visit&& visit);

 private:
  static constexpr Index kTrianglesPerRun = 8;

  struct Place {
    std::uint32_t round = 0;  ///< in which the boxes were found
    Box displacements{Vec3{}}, box{Vec3{}};
  };
  /// Places of patches or groups.
  struct Places {
    std::vector<Place> place;
    const Place& find(const NearPatches& of, const std::vector<NearSurface::Bound>& bounds, Index index);
  };

  const Box& group(std::size_t index) { return groups_.find(*this, surface_.groups(), Index(index)).box; }

  const NearSurface& surface_;
  std::vector<Index> first_vertex_, vertices_;
  std::vector<Box> triangle_rest_, run_rest_;  ///< of triangles, and of runs of kTrianglesPerRun of them
  Places groups_, patches_;
  std::uint32_t round_ = 0;
};

template <class Visit>
void NearPatches::for_each_triangle(Index patch, const Box& region, Visit&& visit) const {
  const NearSurface::Bound& bound = surface_.patches()[std::size_t(patch)];
  for (Index begin = bound.first; begin < bound.last; begin += kTrianglesPerRun) {
    if (!run_rest_[std::size_t(begin / kTrianglesPerRun)].meets(region)) continue;
    const Index end = std::min(begin + kTrianglesPerRun, bound.last);
    for (Index t = begin; t < end; ++t)
      if (rest_of_triangle(t).meets(region)) visit(t);
  }
}

template <class Visit>
void NearPatches::for_each_near(NearPatches& other, const std::vector<double>& reach, Visit&& visit) {
  if (surface_.empty() || other.surface_.empty()) return;
  const Box others = other.all();
  for (std::size_t g = 0; g < surface_.groups().size(); ++g) {
    const NearSurface::Bound& own = surface_.groups()[g];
    const double farthest = *std::max_element(reach.begin() + own.first, reach.begin() + own.last);
    if (!own.rest.moved(surface_.displacements()).grown(farthest).meets(others)) continue;
    const Box box_of_group = group(g).grown(farthest);
    if (!box_of_group.meets(others)) continue;
    for (std::size_t h = 0; h < other.surface_.groups().size(); ++h) {
      const NearSurface::Bound& facing = other.surface_.groups()[h];
      if (!box_of_group.meets(facing.rest.moved(other.surface_.displacements())) || !box_of_group.meets(other.group(h)))
        continue;
      for (Index p = own.first; p < own.last; ++p) {
        const Box box_of_patch = box(p).grown(reach[std::size_t(p)]);
        if (!box_of_patch.meets(other.group(h))) continue;
        for (Index q = facing.first; q < facing.last; ++q)
          if (box_of_patch.meets(other.box(q))) visit(p, q);
      }
    }
  }
}

}  // namespace ctpm::surface
