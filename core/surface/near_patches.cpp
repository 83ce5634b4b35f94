#include "core/surface/near_patches.h"

namespace ctpm::surface {

NearPatches::NearPatches(const NearSurface& surface) : surface_(surface) {
  groups_.place.resize(surface.groups().size()), patches_.place.resize(surface.patches().size());
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
  static_assert(NearSurface::kTrianglesPerPatch % kTrianglesPerRun == 0, "a run belongs to one patch");
  for (const NearSurface::Triangle& t : surface.triangles()) {
    const Box rest(surface.rest(t.corner[0]), surface.rest(t.corner[1]), surface.rest(t.corner[2]));
    if (triangle_rest_.size() % kTrianglesPerRun == 0) run_rest_.push_back(rest);
    triangle_rest_.push_back(rest);
    run_rest_.back().add(rest.low), run_rest_.back().add(rest.high);
  }
}

const NearPatches::Place& NearPatches::Places::find(const NearPatches& of,
                                                    const std::vector<NearSurface::Bound>& bounds, Index index) {
  Place& found = place[std::size_t(index)];
  if (found.round != of.round_) {
    const NearSurface::Bound& bound = bounds[std::size_t(index)];
    found.round = of.round_, found.displacements = of.surface_.displacements(bound);
    found.box = bound.rest.moved(found.displacements);
  }
  return found;
}

}  // namespace ctpm::surface
