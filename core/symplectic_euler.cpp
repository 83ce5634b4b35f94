#include "core/symplectic_euler.h"

namespace ctpm {

void SymplecticEuler::solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity) {
  const std::size_t n = model_.sphere_count();
  set_outer_forces(model_, outside, force_);
  elements.add_forces(state, force_);
  const double* old_velocity[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t c = axis * n + i;
      momentum_[c] = model_.mass[i] * old_velocity[axis][i] + outside.h * force_[c];
      velocity[c] = outside.is_held(i, axis) ? 0.0 : momentum_[c] / model_.mass[i];
    }
  outside.contact.push_apart(outside.h, momentum_, velocity);
  outside.pairs.push_apart(outside.h, outside.held_axes, velocity);
  if (outside.pinned < 0) return;
  const auto i = std::size_t(outside.pinned);
  const Vec3 hand = outside.pin_velocity;
  velocity[i] = hand.x, velocity[n + i] = hand.y, velocity[2 * n + i] = hand.z;
}

Vec3 SymplecticEuler::force_on_pin(const State& state, const Outside& outside) const {
  const std::size_t n = model_.sphere_count();
  const auto i = std::size_t(outside.pinned);
  const Vec3 own{force_[i], force_[n + i], force_[2 * n + i]};
  return own + model_.mass[i] * (state.velocity[i] - outside.pin_velocity) / outside.h;
}

}  // namespace ctpm
