#include "studio/session/cut_depth.h"

#include <algorithm>
#include <cmath>

namespace ctpm {

CutDepth::CutDepth(const Model& model, const std::vector<Surface>& surfaces)
    : model_(model), is_added_(model.edges.size() + model.tpms.size()) {
  for (const Surface& surface : surfaces)
    if (!surface.triangle.empty()) surfaces_.emplace_back(surface.vertex, surface.triangle);
}

void CutDepth::add(const State& state) {
  for (std::size_t i = 0; i < state.edge_severed.size(); ++i)
    if (state.edge_severed[i]) add(i);
  for (std::size_t i = 0; i < state.tpm_severed.size(); ++i)
    if (state.tpm_severed[i]) add(model_.edges.size() + i);
}

void CutDepth::add(std::size_t element) {
  if (is_added_[element] || surfaces_.empty()) return;
  is_added_[element] = true;
  const bool is_edge = element < model_.edges.size();
  const std::size_t i = is_edge ? element : element - model_.edges.size();
  const auto rest = [&](std::int32_t sphere) { return model_.rest_position[std::size_t(sphere)]; };
  const Vec3 middle = is_edge ? 0.5 * (rest(model_.edges.a[i]) + rest(model_.edges.b[i]))
                              : 0.5 * (rest(model_.tpms.a[i]) + rest(model_.tpms.b[i]));
  double nearest2 = INFINITY;
  for (const SurfaceIndex& surface : surfaces_) nearest2 = std::min(nearest2, surface.nearest(middle).squared_distance);
  deepest_ = std::max(deepest_.value_or(0), std::sqrt(nearest2));
}

}  // namespace ctpm
