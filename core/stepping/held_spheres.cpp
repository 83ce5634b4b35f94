#include "core/stepping/held_spheres.h"

namespace ctpm::stepping {

HeldSpheres::HeldSpheres(const Model& model, const parallel::Slabs& slabs)
    : model_(model), slabs_(slabs), of_slab_(std::size_t(slabs.count())) {
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.held_axes[i] != 0) of_slab_[std::size_t(slabs.of(std::int32_t(i)))].push_back(std::int32_t(i));
}

void HeldSpheres::stop(const contact::Pins& pins, int slab, std::array<double*, 3> velocity) const {
  for (const std::int32_t sphere : of_slab_[std::size_t(slab)])
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((model_.held_axes[std::size_t(sphere)] >> axis & 1) != 0) velocity[axis][sphere] = 0;
  for (const contact::Pin& pin : pins) {
    if (pin.sphere < slabs_.begin(slab) || pin.sphere >= slabs_.end(slab)) continue;
    const double hand[3] = {pin.velocity.x, pin.velocity.y, pin.velocity.z};
    for (std::size_t axis = 0; axis < 3; ++axis) velocity[axis][pin.sphere] = hand[axis];
  }
}

}  // namespace ctpm::stepping
