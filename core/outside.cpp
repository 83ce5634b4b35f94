#include "core/outside.h"

namespace ctpm {

void set_outer_forces(const Model& model, const Outside& outside, Coordinates& force) {
  const std::size_t n = model.sphere_count();
  const double gravity[3] = {model.gravity.x, model.gravity.y, model.gravity.z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i) force[axis * n + i] = model.mass[i] * gravity[axis];
  if (!outside.has_loads) return;
  const Loads& loads = model.loads;
  for (std::size_t l = 0; l < loads.size(); ++l) {
    const double since = outside.end_time - loads.start[l];
    const double share = since <= 0 ? 0.0 : (since >= loads.ramp[l] ? 1.0 : since / loads.ramp[l]);
    const Vec3 pull = share * loads.force[l];
    const auto i = std::size_t(loads.sphere[l]);
    force[i] += pull.x, force[n + i] += pull.y, force[2 * n + i] += pull.z;
  }
}

void start_velocities(const State& state, const Outside& outside, Coordinates& velocity) {
  const std::size_t n = state.position.size();
  const double* old[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i)
      velocity[axis * n + i] = outside.is_held(i, axis) ? 0.0 : old[axis][i];
  if (outside.pinned < 0) return;
  const auto i = std::size_t(outside.pinned);
  const Vec3 hand = outside.pin_velocity;
  velocity[i] = hand.x, velocity[n + i] = hand.y, velocity[2 * n + i] = hand.z;
}

}  // namespace ctpm
