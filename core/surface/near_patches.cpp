#include "core/surface/near_patches.h"

namespace ctpm::surface {

NearPatches::NearPatches(const NearSurface& surface)
    : surface_(surface),
      groups_(surface.groups().size(), Box(Vec3{})),
      patches_(surface.patches().size(), Box(Vec3{})),
      found_in_(surface.patches().size(), 0) {
  std::vector<std::uint8_t> is_taken(surface.vertex_count(), 0);
  first_vertex_.push_back(0);
  for (const NearSurface::Bound& patch : surface.patches()) {
    for (Index t = patch.first; t < patch.last; ++t)
      for (const Index corner : surface.triangles()[std::size_t(t)].corner) {
        if (is_taken[std::size_t(corner)]) continue;
        is_taken[std::size_t(corner)] = 1;
        vertices_.push_back(corner);
      }
    first_vertex_.push_back(Index(vertices_.size()));
  }
}

void NearPatches::begin(const Vec3Array& position) {
  position_ = &position;
  ++round_;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g] = surface_.box_of(surface_.groups()[g], position);
    if (g == 0) all_ = groups_[g];
    all_.add(groups_[g].low), all_.add(groups_[g].high);
  }
}

const Box& NearPatches::patch(Index index) {
  const auto p = std::size_t(index);
  if (found_in_[p] != round_) found_in_[p] = round_, patches_[p] = surface_.box_of(surface_.patches()[p], *position_);
  return patches_[p];
}

}  // namespace ctpm::surface
