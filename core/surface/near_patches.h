#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/model/box.h"
#include "core/model/vec3.h"
#include "core/surface/near_surface.h"

namespace ctpm::surface {

/// Where the patches of a NearSurface are, and which patches of two surfaces are near each other.
class NearPatches {
 public:
  using Index = NearSurface::Index;

  explicit NearPatches(const NearSurface& surface);

  /// Finds the boxes of all groups; those of patches follow where they are asked for. `position` must outlive the
  /// round.
  void begin(const Vec3Array& position);

  /// Vertices of a patch; a vertex of several patches belongs to the first.
  std::span<const Index> vertices(Index patch) const {
    const auto begin = std::size_t(first_vertex_[std::size_t(patch)]);
    return std::span(vertices_).subspan(begin, std::size_t(first_vertex_[std::size_t(patch) + 1]) - begin);
  }

  /// Box that contains a patch [m].
  const Box& patch(Index index);

  /// Calls `visit(patch, other_patch)` for the patches whose boxes are nearer than `reach` [m], in a fixed order.
  template <class Visit>
  void for_each_near(NearPatches& other, double reach, Visit&& visit);

 private:
  const NearSurface& surface_;
  std::vector<Index> first_vertex_, vertices_;
  const Vec3Array* position_ = nullptr;
  Box all_{Vec3{}};
  std::vector<Box> groups_, patches_;
  std::vector<std::uint32_t> found_in_;  ///< round that found the box of a patch
  std::uint32_t round_ = 0;
};

template <class Visit>
void NearPatches::for_each_near(NearPatches& other, double reach, Visit&& visit) {
  if (groups_.empty() || other.groups_.empty() || !all_.grown(reach).meets(other.all_)) return;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Box group = groups_[g].grown(reach);
    if (!group.meets(other.all_)) continue;
    for (std::size_t h = 0; h < other.groups_.size(); ++h) {
      if (!group.meets(other.groups_[h])) continue;
      const NearSurface::Bound &own = surface_.groups()[g], &others = other.surface_.groups()[h];
      for (Index p = own.first; p < own.last; ++p) {
        const Box box = patch(p).grown(reach);
        if (!box.meets(other.groups_[h])) continue;
        for (Index q = others.first; q < others.last; ++q)
          if (box.meets(other.patch(q))) visit(p, q);
      }
    }
  }
}

}  // namespace ctpm::surface
