#include "core/model/state.h"

namespace ctpm {

State rest_state(const Model& model) {
  State state;
  state.position = model.rest_position;
  state.velocity = Vec3Array(model.sphere_count());
  if (model.solver.integrator == Integrator::sdirk2) state.acceleration.resize(model.sphere_count());
  state.kelvin_elongation.assign(model.axial.internal_count(), 0.0);
  if (model.has_scalpel()) {
    state.axial_severed.assign(model.axial.size(), 0);
    state.constraint_severed.assign(model.constraints.size(), 0);
    state.angle_severed.assign(model.angle_springs.size(), 0);
    state.axial_crossing.assign(model.axial.size(), 0);
    state.blade_trail.resize(kEdgeNodes);
    state.edge_organ.assign(kEdgeNodes, -1);
  }
  return state;
}

}  // namespace ctpm
