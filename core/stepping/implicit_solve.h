#pragma once

#include <optional>

#include "core/solver/linear_solver.h"
#include "core/stepping/external_loads.h"
#include "core/stepping/held_spheres.h"
#include "core/stepping/step.h"
#include "core/stepping/substep.h"

namespace ctpm::stepping {

/// Solves an implicit step, linearised once: one step of Newton's method for M (v' - v) = h f(x + h v', v'), that is
/// (M + h C + h^2 K) dv = residual. Terms that would make the matrix indefinite are left out (Baraff & Witkin, "Large
/// steps in cloth simulation", 1998). If contacts would pull, they are dropped and the step is solved again. Backward
/// Euler and both stages of SDIRK2 use it.
class ImplicitSolve {
 public:
  explicit ImplicitSolve(const StepContext& context);

  /// Returns the velocity [m/s] at the end of a step of `part` from `start`, linearised about spheres at rest; valid
  /// until the next solve (3 x sphere_count). Writes the force on the tool, iterations and residual to `report`.
  const elements::Coordinates& solve(const StateView& start, const Substep& part, contact::ImplicitContacts& contacts,
                                     StepReport& report);

  /// As above, linearised about a predictor of the end. `predicted` has the predicted velocity and the positions to
  /// which it leads; `before` is the velocity [m/s] at the start. With `keeps_matrix`, the elements' part of the matrix
  /// is that of the last solve, which must have been of the same length, and Kelvin elongations are those at the end of
  /// the step. `change`: result minus predicted velocity [m/s] (3 x sphere_count).
  const elements::Coordinates& solve_near(const StateView& predicted, const Vec3Array& before, bool keeps_matrix,
                                          const Substep& part, contact::ImplicitContacts& contacts,
                                          elements::Coordinates& change, StepReport& report);

  /// v . M v [J], twice the kinetic energy of velocity `v` [m/s].
  double energy_of(const elements::Coordinates& v) { return solver_.energy_of(v); }

 private:
  /// The velocities from which a step is solved.
  struct Beginning {
    const Vec3Array& before;      ///< at the start of the step
    const Vec3Array* prediction;  ///< predictor of the velocity at the end; null: none
    solver::FirstGuess guess;     ///< of the first solve; it has the elements' part of the product
  };

  void begin(const StateView& state, const contact::Pins& pins, const ExternalLoads& loads, int slab);
  void begin_blocks(int slab);
  void solve_contacts(const Beginning& beginning, contact::ImplicitContacts& contacts,
                      const inversion::LinearisedResistance& resistance, elements::Coordinates& change,
                      StepReport& report);
  void find_momentum(const Beginning& beginning, double h, int slab);
  void report_forces(const Beginning& beginning, const contact::ContactStep& step,
                     const contact::LinearisedContacts& contacts, const inversion::LinearisedResistance& resistance,
                     const elements::Coordinates& change, StepReport& report);

  const StepContext& context_;
  HeldSpheres held_;
  solver::LinearSolver solver_;
  solver::SolverLimits limits_;
  elements::Coordinates force_, momentum_, velocity_;
  elements::DiagonalBlocks blocks_;
};

}  // namespace ctpm::stepping
