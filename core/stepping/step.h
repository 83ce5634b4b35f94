#pragma once

#include <cstdint>
#include <memory>

#include "core/elements/kernels/kernels.h"
#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/state.h"
#include "core/stepping/integrator.h"

namespace ctpm::stepping {

enum class StepStatus : std::int32_t {
  ok = 0,
  not_converged = 1,  ///< the solve stopped at its count; State went on with what was reached
  bad_input = 2,      ///< the tool's pose is not finite or its index unknown; State is as before the step
  diverged = 3,       ///< a number became infinite or not a number; State is as before the step
  too_long = 4,       ///< the explicit integrator of the Model cannot hold steps of this length; State is as before
};

/// Whether a tick was not done, and State is as before it.
constexpr bool is_refused(StepStatus status) { return status >= StepStatus::bad_input; }

/// What one tick did. Never thrown, always complete.
struct StepReport {
  StepStatus status = StepStatus::ok;
  std::int32_t worst_sphere = -1;  ///< sphere that failed or moves fastest; -1: none
  double residual = 0;             ///< of the last solve, relative
  std::int32_t iterations = 0;     ///< of all solves of the tick
  Vec3 tool_force;                 ///< force of the tissue on the tool, ball, pin or blade [N]
  double depth = 0;                ///< largest displacement from rest of a touched sphere, along the contact [m]
  std::int32_t contacts = 0;       ///< spheres touched; by a blade, elements before its edge or on its flanks
  std::int32_t severed = 0;        ///< elements severed in this tick
  std::int32_t came_loose = 0;     ///< pieces that came loose in this tick: how many more there are than before
};

/// What a Stepper may use of the machine. None of it changes a bit of what comes out.
struct StepperOptions {
  int threads = 1;  ///< >= 1; more only help from some thousand spheres on
  elements::InstructionSet instruction_set = elements::best_instruction_set();
};

/// Advances States of one Model. Holds the kernels chosen for the Model and their scratch memory, nothing
/// else: any State of the Model may be given at any call, in any order, and step() allocates nothing.
class Stepper {
 public:
  /// `model` must outlive the Stepper.
  explicit Stepper(const Model& model, const StepperOptions& options = {});
  ~Stepper();
  Stepper(Stepper&&) noexcept;

  /// One tick. Same Model, State and Inputs: the same bits, on every machine.
  StepReport step(State& state, const Inputs& inputs);

  /// Lets the scene come to rest under gravity without a tool, for at most `ticks` ticks; State::tick stays
  /// 0.
  StepReport settle(State& state, std::int64_t ticks);

  /// The Model's integrator, and whether it holds.
  const IntegratorChoice& integrator() const;

 private:
  struct Parts;
  const Model& model_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::stepping
