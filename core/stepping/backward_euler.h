#pragma once

#include <optional>

#include "core/elements/elements.h"
#include "core/solver/linear_solver.h"
#include "core/stepping/outside.h"
#include "core/stepping/step.h"

namespace ctpm {

/// Backward Euler, linearised once: one substep solves M (v' - v) = h f(x + h v', v'), x' = x + h v', by one step of
/// Newton's method: (M + h C + h^2 K) dv = its residual. First order, L-stable: as stiff a dashpot as one likes. Baraff
/// & Witkin, "Large steps in cloth simulation" (1998), with what would make the matrix indefinite left out of it.
class BackwardEuler {
 public:
  BackwardEuler(const Model& model, const Slabs& slabs, Team& team, const Kernels& kernels);

  /// `velocity` [m/s] at the end of the substep that begins with State (3 x sphere_count), linearised about spheres
  /// that rest; contacts that would pull are dropped. Force on the tool, iterations and residual go into `report`.
  void solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity, StepReport& report);

  /// As above, linearised about a guess of the end: State::velocity is that guess, State::position where it leads,
  /// `before` the velocity [m/s] at the start. With `keeps_matrix` the tissue's part of the matrix is still that of the
  /// last solve, which must have been of the same length, and State::kelvin_elongation is that of the end too.
  void solve_near(Elements& elements, const State& state, const Vec3Array& before, bool keeps_matrix, Outside& outside,
                  Coordinates& velocity, StepReport& report);

  /// Which part of the kinetic energy that `velocity` has at the end the guess of the last solve_near() missed;
  /// `pinned`, a sphere that does not count.
  double unforeseen(const Coordinates& velocity, std::int32_t pinned);

 private:
  /// What a substep is solved from.
  struct Beginning {
    const Vec3Array& before;             ///< velocity at its start
    const Vec3Array* guess;              ///< of that at its end; null: none
    std::optional<double> guess_energy;  ///< LinearSolver::energy_of() it
  };

  void begin(const State& state, const Outside& outside, int slab, Coordinates& velocity);
  void begin_blocks(int slab);
  void solve_contacts(const Elements& elements, const Beginning& beginning, Outside& outside, Coordinates& change,
                      StepReport& report);
  SolverOutcome solve_round(const Elements& elements, const Outside& outside, std::optional<double> energy,
                            Coordinates& change);
  Vec3 force_on_pin(const Elements& elements, Vec3 before, const Outside& outside, const Coordinates& change);

  const Model& model_;
  const Slabs& slabs_;
  Team& team_;
  HeldSpheres held_;
  LinearSolver solver_;
  SolverLimits limits_;
  Coordinates force_, momentum_;
  Coordinates change_;  ///< from the last guess; empty for other integrators than SDIRK2
  DiagonalBlocks blocks_;
};

}  // namespace ctpm
