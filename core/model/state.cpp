#include "core/model/state.h"

namespace ctpm {

State rest_state(const Model& model) {
  State state;
  state.position = model.rest_position;
  state.velocity = Vec3Array(model.sphere_count());
  if (model.solver.integrator == Integrator::sdirk2) state.acceleration.resize(model.sphere_count());
  state.kelvin_elongation.assign(model.tpms.size(), 0.0);
  if (model.has_scalpel()) {
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
