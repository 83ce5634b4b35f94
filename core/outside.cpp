#include "core/outside.h"

namespace ctpm {

void set_weight(const Model& model, std::size_t begin, std::size_t end, Coordinates& force) {
  const std::size_t n = model.sphere_count();
  const double gravity[3] = {model.gravity.x, model.gravity.y, model.gravity.z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = begin; i < end; ++i) force[axis * n + i] = model.mass[i] * gravity[axis];
}

void add_loads(const Model& model, const Outside& outside, Coordinates& force) {
  if (!outside.has_loads) return;
  const std::size_t n = model.sphere_count();
  const Loads& loads = model.loads;
  for (std::size_t l = 0; l < loads.size(); ++l) {
    const double since = outside.end_time - loads.start[l];
    const double share = since <= 0 ? 0.0 : (since >= loads.ramp[l] ? 1.0 : since / loads.ramp[l]);
    const Vec3 pull = share * loads.force[l];
    const auto i = std::size_t(loads.sphere[l]);
    force[i] += pull.x, force[n + i] += pull.y, force[2 * n + i] += pull.z;
  }
}

void find_momentum(const Model& model, const State& state, double h, const Coordinates& force, std::size_t begin,
                   std::size_t end, Coordinates& momentum) {
  const std::size_t n = model.sphere_count();
  const double* velocity[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  const double* mass = model.mass.data();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double *f = &force[axis * n], *v = velocity[axis];
    double* __restrict out = &momentum[axis * n];
    for (std::size_t i = begin; i < end; ++i) out[i] = mass[i] * v[i] + h * f[i];
  }
}

void start_velocities(const State& state, const Outside& outside, std::size_t begin, std::size_t end,
                      Coordinates& velocity) {
  const std::size_t n = state.position.size();
  const double* old[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = begin; i < end; ++i)
      velocity[axis * n + i] = outside.is_held(i, axis) ? 0.0 : old[axis][i];
  if (outside.pinned < std::int32_t(begin) || outside.pinned >= std::int32_t(end)) return;
  const auto i = std::size_t(outside.pinned);
  const Vec3 hand = outside.pin_velocity;
  velocity[i] = hand.x, velocity[n + i] = hand.y, velocity[2 * n + i] = hand.z;
}

}  // namespace ctpm
