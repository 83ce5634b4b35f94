#include "core/symplectic_euler.h"

#include "core/only_springs.h"

namespace ctpm {

void SymplecticEuler::solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity) {
  const std::size_t n = model_.sphere_count();
  const auto for_each_slab = [&](auto&& part) {
    team_.for_each(slabs_.count(),
                   [&](int slab) { part(std::size_t(slabs_.begin(slab)), std::size_t(slabs_.end(slab))); });
  };
  for_each_slab([&](std::size_t begin, std::size_t end) { set_weight(model_, begin, end, force_); });
  add_loads(model_, outside, force_);
  elements.add_forces(state, force_);
  for_each_slab([&](std::size_t begin, std::size_t end) {
    find_momentum(model_, state, outside.h, force_, begin, end, momentum_);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = begin; i < end; ++i)
        velocity[axis * n + i] = outside.is_held(i, axis) ? 0.0 : momentum_[axis * n + i] / model_.mass[i];
  });
  if constexpr (kOnlySprings) return;
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
