#pragma once

#include "core/block_jacobi.h"
#include "core/conjugate_gradient.h"
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
  explicit BackwardEuler(const Model& model);

  /// `velocity` [m/s] at the end of the substep (3 x sphere_count); contacts that would pull are dropped.
  /// Iterations and residual go into `report`.
  void solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity, StepReport& report);

  /// What the tissue did to the pin in the substep just solved [N].
  Vec3 force_on_pin(const Elements& elements, const State& state, const Outside& outside,
                    const Coordinates& velocity);

 private:
  CgOutcome solve_round(const Elements& elements, const State& state, const Outside& outside,
                        Coordinates& velocity);
  void apply(const Elements& elements, const State& state, const Outside& outside, const Coordinates& in,
             Coordinates& out) const;
  void uncouple_guided(const Outside& outside);

  const Model& model_;
  BlockJacobi jacobi_;
  ConjugateGradient solver_;
  CgLimits limits_;
  std::vector<std::int32_t> guided_;  ///< spheres of which some axes are held and others not
  Coordinates force_, momentum_;
  DiagonalBlocks blocks_;
};

}  // namespace ctpm
