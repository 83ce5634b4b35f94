#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/pin.h"
#include "core/model/model.h"
#include "core/parallel/slabs.h"

namespace ctpm::stepping {

/// Spheres that are held along one axis or more.
class HeldSpheres {
 public:
  HeldSpheres(const Model& model, const parallel::Slabs& slabs);

  /// Sets the velocities of a slab's spheres to 0 along held axes, and those of the pins' spheres to the pins'
  /// velocities. `velocity`: x, y and z [m/s] (sphere_count each).
  void stop(const contact::Pins& pins, int slab, std::array<double*, 3> velocity) const;

 private:
  const Model& model_;
  const parallel::Slabs& slabs_;
  std::vector<std::vector<std::int32_t>> of_slab_;
};

}  // namespace ctpm::stepping
