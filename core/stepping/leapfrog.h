#pragma once

#include "core/model/state.h"
#include "core/stepping/held_spheres.h"
#include "core/stepping/motion.h"
#include "core/stepping/step.h"
#include "core/stepping/substep.h"
#include "core/stepping/velocity_check.h"

namespace ctpm::stepping {

/// Leapfrog (position Verlet): half a step of drift with the old velocity, a kick v' = v + h M^-1 f, and half a step of
/// drift with the new velocity. Second order with one evaluation of the forces (Leimkuhler & Reich, "Simulating
/// Hamiltonian dynamics", 2004, ch. 4); first order in the dashpots, which see the old velocity. It is explicit in the
/// elements and solves each contact and each tetrahedron that resists inversion implicitly by itself. Stable for steps
/// up to stable_step_bound() (integrator.h).
class Leapfrog {
 public:
  explicit Leapfrog(const StepContext& context);

  /// One substep from `from` into `to`. False: the step is refused, `report` says why, and `to` is not usable.
  bool step(const State& from, const contact::HeldTools& tools, const Substep& part, Motion& to, StepReport& report);

 private:
  const Vec3Array& start_velocity(const State& from, const contact::Pins& pins);
  void kick(const StateView& middle, const contact::Pins& pins, const Substep& part, Vec3Array& velocity);

  const StepContext& context_;
  HeldSpheres held_;
  VelocityCheck check_;
  std::vector<double> per_mass_;  ///< 1 / mass [1/kg]  (sphere_count)
  elements::Coordinates force_;   ///< [N]
  Vec3Array pinned_velocity_;     ///< of State, with those of the pins; empty if the Model has no pin (sphere_count)
};

}  // namespace ctpm::stepping
