#include "core/stepping/leapfrog.h"

#include "core/elements/only_springs.h"

namespace ctpm {

Leapfrog::Leapfrog(const Model& model, const Slabs& slabs)
    : model_(model), slabs_(slabs), held_(model, slabs), force_(3 * model.sphere_count()) {
  per_mass_.reserve(model.sphere_count());
  for (const double mass : model.mass) per_mass_.push_back(1 / mass);
}

void Leapfrog::solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity,
                     StepReport& report) {
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
  outside.contact.push_apart(outside.h, outside.held_axes, state.velocity, velocity);
  outside.pairs.push_apart(outside.h, outside.held_axes, state.velocity, velocity);
  report.tool_force =
      outside.contact.force_on_tool(outside.h, velocity) + outside.pairs.force_on_tool(outside.h, velocity);
  if (outside.pinned < 0) return;
  const auto i = std::size_t(outside.pinned);
  const Vec3 own{force_[i], force_[n + i], force_[2 * n + i]};
  report.tool_force = own + model_.mass[i] * (outside.velocity_before_pin - outside.pin_velocity) / outside.h;
}

}  // namespace ctpm
