#include "core/state.h"

#include <algorithm>

namespace ctpm {

State rest_state(const Model& model) {
  State state;
  state.position = model.rest_position;
  state.velocity = Vec3Array(model.sphere_count());
  state.kelvin_elongation.assign(model.tpms.size(), 0.0);
  const bool can_cut = std::any_of(model.tools.begin(), model.tools.end(),
                                   [](const Tool& tool) { return tool.kind == ToolKind::scalpel; });
  if (can_cut) {
    state.edge_severed.assign(model.edges.size(), 0);
    state.tpm_severed.assign(model.tpms.size(), 0);
    state.constraint_severed.assign(model.constraints.size(), 0);
    state.angle_severed.assign(model.angle_springs.size(), 0);
    state.edge_crossing.assign(model.edges.size(), 0);
    state.tpm_crossing.assign(model.tpms.size(), 0);
    state.blade_trail.resize(2);
  }
  return state;
}

}  // namespace ctpm
