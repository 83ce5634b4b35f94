#pragma once

#include "core/elements.h"
#include "core/outside.h"

namespace ctpm {

/// Symplectic (semi-implicit) Euler: v' = v + h M^-1 f(x, v), x' = x + h v'. First order, explicit in the
/// elements and implicit in each contact by itself, which couples no two spheres. Holds for steps up to
/// stable_step_bound() (integrator.h).
class SymplecticEuler {
 public:
  SymplecticEuler(const Model& model, const Slabs& slabs);

  /// `velocity` [m/s] at the end of the substep (3 x sphere_count); contacts that would pull are dropped.
  void solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity);

  /// What the tissue did to the pin in the substep just solved [N].
  Vec3 force_on_pin(const State& state, const Outside& outside) const;

 private:
  const Model& model_;
  const Slabs& slabs_;
  HeldSpheres held_;
  std::vector<double> per_mass_;  ///< 1 / mass [1/kg] (sphere_count)
  Coordinates force_;
};

}  // namespace ctpm
