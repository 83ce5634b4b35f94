#include "core/symplectic_euler.h"

#include "core/only_springs.h"

namespace ctpm {

SymplecticEuler::SymplecticEuler(const Model& model, const Slabs& slabs)
    : model_(model), slabs_(slabs), held_(model, slabs), force_(3 * model.sphere_count()) {
  per_mass_.reserve(model.sphere_count());
  for (const double mass : model.mass) per_mass_.push_back(1 / mass);
}

void SymplecticEuler::solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity) {
  const std::size_t n = model_.sphere_count();
  const double* old[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  const auto start = [&](int slab) {
    const auto begin = std::size_t(slabs_.begin(slab)), end = std::size_t(slabs_.end(slab));
    set_weight(model_, begin, end, force_);
    add_loads(model_, outside, begin, end, force_);
  };
  const auto accelerate = [&](int slab) {
    const double h = outside.h, *per_mass = per_mass_.data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double *force = &force_[axis * n], *v = old[axis];
      double* __restrict out = &velocity[axis * n];
      for (auto i = std::size_t(slabs_.begin(slab)); i < std::size_t(slabs_.end(slab)); ++i)
        out[i] = v[i] + h * per_mass[i] * force[i];
    }
    held_.stop(outside, slab, velocity);
  };
  elements.add_forces(state, force_, start, accelerate);
  if constexpr (kOnlySprings) return;
  outside.contact.push_apart(outside.h, velocity);
  outside.pairs.push_apart(outside.h, outside.held_axes, velocity);
}

Vec3 SymplecticEuler::force_on_pin(const State& state, const Outside& outside) const {
  const std::size_t n = model_.sphere_count();
  const auto i = std::size_t(outside.pinned);
  const Vec3 own{force_[i], force_[n + i], force_[2 * n + i]};
  return own + model_.mass[i] * (state.velocity[i] - outside.pin_velocity) / outside.h;
}

}  // namespace ctpm
