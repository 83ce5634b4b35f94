#pragma once

#include "core/model/state.h"
#include "core/stepping/backward_euler.h"
#include "core/stepping/implicit_solve.h"
#include "core/stepping/motion.h"
#include "core/stepping/step.h"
#include "core/stepping/substep.h"
#include "core/stepping/velocity_check.h"

namespace ctpm::stepping {

/// SDIRK2: L-stable, second order (Alexander, "Diagonally implicit Runge-Kutta methods for stiff O.D.E.'s", 1977). Each
/// of its two stages is a shorter step of backward Euler, linearised about a predictor. The second stage starts from
/// the first, extrapolated over the rest of the step. If the step is too long for the motion, backward Euler does it
/// alone, and the report counts it.
class Sdirk2 {
 public:
  /// `context` and `solve` must outlive the integrator.
  Sdirk2(const StepContext& context, ImplicitSolve& solve);

  /// One substep from `from` into `to`. False: the step is refused, `report` says why, and `to` is not usable.
  bool step(const State& from, const contact::HeldTools& tools, const Substep& part, Motion& to, StepReport& report);

 private:
  bool is_short(const State& from, const contact::HeldTools& tools, const Substep& part) const;
  bool two_stages(const State& from, const contact::HeldTools& tools, const Substep& part, Motion& to,
                  StepReport& report);
  bool dirk_stage(const StateView& start, const contact::HeldTools& tools, const Substep& part, bool is_second,
                  Motion& to, StepReport& report);
  bool was_predicted();

  const StepContext& context_;
  ImplicitSolve& solve_;
  BackwardEuler fallback_;
  VelocityCheck check_;
  double shortest_element_;                                ///< at rest [m]
  Motion predicted_;                                       ///< predictor of the end of a stage
  Motion second_start_;                                    ///< end of the first stage, then start of the second
  elements::Coordinates change_;                           ///< velocity of the last stage minus its predictor [m/s]
  const elements::Coordinates* stage_velocity_ = nullptr;  ///< solution of the last stage
  contact::Pins stage_pins_;                               ///< of the last stage
};

}  // namespace ctpm::stepping
