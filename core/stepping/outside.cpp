#include "core/stepping/outside.h"

#include <utility>

namespace ctpm {

HeldSpheres::HeldSpheres(const Model& model, const Slabs& slabs)
    : model_(model), slabs_(slabs), of_slab_(std::size_t(slabs.count())) {
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.held_axes[i] != 0) of_slab_[std::size_t(slabs.of(std::int32_t(i)))].push_back(std::int32_t(i));
}

void HeldSpheres::stop(const Outside& outside, int slab, Coordinates& velocity) const {
  const std::size_t n = model_.sphere_count();
  for (const std::int32_t sphere : of_slab_[std::size_t(slab)])
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((model_.held_axes[std::size_t(sphere)] >> axis & 1) != 0) velocity[axis * n + std::size_t(sphere)] = 0;
  if (outside.pinned < slabs_.begin(slab) || outside.pinned >= slabs_.end(slab)) return;
  const auto i = std::size_t(outside.pinned);
  const Vec3 hand = outside.pin_velocity;
  velocity[i] = hand.x, velocity[n + i] = hand.y, velocity[2 * n + i] = hand.z;
}

void set_weight(const Model& model, std::size_t begin, std::size_t end, Coordinates& force) {
  const std::size_t n = model.sphere_count();
  const double gravity[3] = {model.gravity.x, model.gravity.y, model.gravity.z};
  const double* mass = model.mass.data();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double* __restrict out = &force[axis * n];
    for (std::size_t i = begin; i < end; ++i) out[i] = mass[i] * gravity[axis];
  }
}

void add_loads(const Model& model, const Outside& outside, std::size_t begin, std::size_t end, Coordinates& force) {
  if (!outside.has_loads) return;
  const std::size_t n = model.sphere_count();
  const Loads& loads = model.loads;
  for (std::size_t l = 0; l < loads.size(); ++l) {
    const auto i = std::size_t(loads.sphere[l]);
    if (i < begin || i >= end) continue;
    const double since = outside.time - loads.start[l];
    const double share = since <= 0 ? 0.0 : (since >= loads.ramp[l] ? 1.0 : since / loads.ramp[l]);
    const Vec3 pull = share * loads.force[l];
    force[i] += pull.x, force[n + i] += pull.y, force[2 * n + i] += pull.z;
  }
}

void find_momentum(const Model& model, const Vec3Array& velocity, const Vec3Array* guess, double h,
                   const Coordinates& force, std::size_t begin, std::size_t end, Coordinates& momentum) {
  const std::size_t n = model.sphere_count();
  const double* mass = model.mass.data();
  for (const auto& [axis, of] : {std::pair{0, &Vec3Array::x}, {1, &Vec3Array::y}, {2, &Vec3Array::z}}) {
    const double *f = &force[std::size_t(axis) * n], *v = (velocity.*of).data();
    const double* from = guess != nullptr ? (guess->*of).data() : nullptr;
    double* __restrict out = &momentum[std::size_t(axis) * n];
    if (from == nullptr)
      for (std::size_t i = begin; i < end; ++i) out[i] = mass[i] * v[i] + h * f[i];
    else
      for (std::size_t i = begin; i < end; ++i) out[i] = mass[i] * (v[i] - from[i]) + h * f[i];
  }
}

}  // namespace ctpm
