#pragma once

#include "core/linear_solver.h"
#include "core/elements.h"
#include "core/outside.h"
#include "core/step.h"

namespace ctpm {

/// Backward Euler, linearised once: one substep solves
///   (M + h C + h^2 K) v' = M v + h (f_elastic(x) + f_contact(x) + M g),  x' = x + h v'.
/// First order, L-stable: as stiff a dashpot as one likes. Baraff & Witkin, "Large steps in cloth simulation"
/// (1998), with what would make the matrix indefinite left out of it.
class BackwardEuler {
 public:
  BackwardEuler(const Model& model, const Slabs& slabs, Team& team, const Kernels& kernels);

  /// `velocity` [m/s] at the end of the substep (3 x sphere_count); contacts that would pull are dropped.
  /// Iterations and residual go into `report`.
  void solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity, StepReport& report);

  /// What the tissue did to the pin in the substep just solved [N].
  Vec3 force_on_pin(const Elements& elements, const State& state, const Outside& outside,
                    const Coordinates& velocity);

 private:
  SolverOutcome solve_round(const Elements& elements, const State& state, const Outside& outside,
                        Coordinates& velocity);

  const Model& model_;
  const Slabs& slabs_;
  Team& team_;
  HeldSpheres held_;
  LinearSolver solver_;
  SolverLimits limits_;
  Coordinates force_, momentum_;
  DiagonalBlocks blocks_;
};

}  // namespace ctpm
