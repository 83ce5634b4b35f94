#include "studio/session/cut_depth.h"

#include <algorithm>
#include <cmath>

namespace ctpm::session {

CutDepth::CutDepth(const Model& model) : model_(model), is_added_(model.axial.size()) {
  for (const Surface& surface : model.surfaces)
    if (!surface.triangle.empty()) surfaces_.emplace_back(surface.vertex, surface.triangle);
}

void CutDepth::add(const State& state) {
  for (std::size_t i = 0; i < state.axial_severed.size(); ++i)
    if (state.axial_severed[i]) add(i);
}

void CutDepth::add(std::size_t element) {
  if (is_added_[element] || surfaces_.empty()) return;
  is_added_[element] = true;
  const auto rest = [&](std::int32_t sphere) { return model_.rest_position[std::size_t(sphere)]; };
  const Vec3 middle = 0.5 * (rest(model_.axial.a[element]) + rest(model_.axial.b[element]));
  double nearest2 = INFINITY;
  for (const importers::SurfaceIndex& surface : surfaces_)
    nearest2 = std::min(nearest2, surface.nearest(middle).squared_distance);
  deepest_ = std::max(deepest_.value_or(0), std::sqrt(nearest2));
}

}  // namespace ctpm::session
