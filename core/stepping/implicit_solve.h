#pragma once

#include <optional>

#include "core/solver/linear_solver.h"
#include "core/stepping/external_loads.h"
#include "core/stepping/held_spheres.h"
#include "core/stepping/step.h"
#include "core/stepping/substep.h"

namespace ctpm::stepping {

/// The solve of an implicit step, linearised once: M (v' - v) = h f(x + h v', v') by one step of Newton's method,
/// (M + h C + h^2 K) dv = its residual, with what would make the matrix indefinite left out of it (Baraff & Witkin,
/// "Large steps in cloth simulation", 1998). Contacts that would pull are dropped, and the step is solved again. What
/// backward Euler and both stages of SDIRK2 share.
class ImplicitSolve {
 public:
  explicit ImplicitSolve(const StepContext& context);

  /// Velocity [m/s] at the end of a step of `part` that begins with `start`, linearised about spheres that rest; valid
  /// until the next solve  (3 x sphere_count). Force on the tool, iterations and residual go into `report`.
  const elements::Coordinates& solve(const StateView& start, const Substep& part, contact::ImplicitContacts& contacts,
                                     StepReport& report);

  /// As above, linearised about a prediction of the end: `predicted` has its velocity, and the positions to which that
  /// leads; `before` is the velocity [m/s] at the start. With `keeps_matrix`, the elements' part of the matrix is that
  /// of the last solve, which must have been of the same length, and Kelvin elongations are those at the end of the
  /// step. `change`: by which the result differs from the prediction [m/s]  (3 x sphere_count).
  const elements::Coordinates& solve_near(const StateView& predicted, const Vec3Array& before, bool keeps_matrix,
                                          const Substep& part, contact::ImplicitContacts& contacts,
                                          elements::Coordinates& change, StepReport& report);

  /// v . M v [J], twice the kinetic energy of velocity `v` [m/s].
  double energy_of(const elements::Coordinates& v) { return solver_.energy_of(v); }

 private:
  /// What a step is solved from.
  struct Beginning {
    const Vec3Array& before;                    ///< velocity at its start
    const Vec3Array* prediction = nullptr;      ///< of the velocity at its end; null: none
    std::optional<double> prediction_energy{};  ///< energy_of() it
  };

  void begin(const StateView& state, const contact::Pin& pin, const ExternalLoads& loads, int slab);
  void begin_blocks(int slab);
  void solve_contacts(const Beginning& beginning, contact::ImplicitContacts& contacts, elements::Coordinates& change,
                      StepReport& report);
  void find_momentum(const Beginning& beginning, double h, int slab);
  Vec3 force_on_pin(Vec3 before, const contact::ContactStep& step, const elements::Coordinates& change);

  const StepContext& context_;
  HeldSpheres held_;
  solver::LinearSolver solver_;
  solver::SolverLimits limits_;
  elements::Coordinates force_, momentum_, velocity_;
  elements::DiagonalBlocks blocks_;
};

}  // namespace ctpm::stepping
