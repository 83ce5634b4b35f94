#pragma once

#include <vector>

#include "core/model/vec3.h"
#include "core/stepping/step.h"
#include "core/stepping/substep.h"

namespace ctpm::stepping {

/// Refuses unphysical velocities.
class VelocityCheck {
 public:
  explicit VelocityCheck(const StepContext& context);

  /// Names the fastest sphere in `report`. False: it is faster than 10^4 m/s or not a number, and `report` says
  /// StepStatus::diverged.
  bool passes(const Vec3Array& velocity, StepReport& report);

 private:
  const StepContext& context_;
  std::vector<double> fastest_of_slab_;  ///< squared speed [m^2/s^2]  (slab_count)
};

}  // namespace ctpm::stepping
