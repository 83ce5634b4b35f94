#pragma once

#include "core/model/state.h"
#include "core/stepping/implicit_solve.h"
#include "core/stepping/motion.h"
#include "core/stepping/step.h"
#include "core/stepping/substep.h"
#include "core/stepping/velocity_check.h"

namespace ctpm::stepping {

/// Backward Euler: M (v' - v) = h f(x + h v', v'), x' = x + h v', linearised once (ImplicitSolve). First order,
/// L-stable for dashpots of any stiffness.
class BackwardEuler {
 public:
  /// `context` and `solve` must outlive the integrator.
  BackwardEuler(const StepContext& context, ImplicitSolve& solve) : context_(context), solve_(solve), check_(context) {}

  /// One substep from `from` into `to`. False: the step is refused, `report` says why, and `to` is not usable.
  bool step(const State& from, const contact::HeldTools& tools, const Substep& part, Motion& to, StepReport& report);

 private:
  const StepContext& context_;
  ImplicitSolve& solve_;
  VelocityCheck check_;
};

}  // namespace ctpm::stepping
