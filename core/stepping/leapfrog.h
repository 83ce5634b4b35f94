#pragma once

#include "core/elements/elements.h"
#include "core/stepping/outside.h"
#include "core/stepping/step.h"

namespace ctpm {

/// The kick of a leapfrog step (position Verlet): half of the way is gone with the old velocity, v' = v + h M^-1 f
/// there, and the other half follows with the new one. Second order for one evaluation of the forces (Leimkuhler &
/// Reich, "Simulating Hamiltonian dynamics", 2004, ch. 4), of first order in the dashpots, which see the old velocity.
/// Explicit in the elements, implicit in each contact by itself, one after the other. Holds for steps up to
/// stable_step_bound() (integrator.h).
class Leapfrog {
 public:
  Leapfrog(const Model& model, const Slabs& slabs);

  /// `velocity` [m/s] at the end of the step (3 x sphere_count) from a State in its middle, which has the velocity of
  /// its start; contacts that would pull are dropped. The force on the tool goes into `report`.
  void solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity, StepReport& report);

 private:
  const Model& model_;
  const Slabs& slabs_;
  HeldSpheres held_;
  std::vector<double> per_mass_;  ///< 1 / mass [1/kg] (sphere_count)
  Coordinates force_;
};

}  // namespace ctpm
