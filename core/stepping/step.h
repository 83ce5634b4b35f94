#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "core/elements/kernels/kernels.h"
#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/stage.h"
#include "core/model/state.h"
#include "core/stepping/integrator.h"

namespace ctpm::stepping {

enum class StepStatus : std::int32_t {
  ok = 0,
  not_converged = 1,  ///< the solve reached its iteration limit; State advances with the last iterate
  /// A tool's index is unknown, its position not finite or its quaternion not of unit length, or the hands cannot hold
  /// their tools at once (hands_conflict()); State is as before.
  bad_input = 2,
  diverged = 3,  ///< a sphere is faster than 10^4 m/s or its speed not a number; State is as before
  too_long = 4,  ///< steps are longer than leapfrog is proven stable for; State is as before
};

/// Whether the tick was refused, and State is as before it.
constexpr bool is_refused(StepStatus status) { return status >= StepStatus::bad_input; }

/// What a tick did to the tool in one hand.
struct HandReport {
  Vec3 tool_force;  ///< force of the tissue on the tool: ball, pin or blade [N]
  /// Largest displacement from rest of a point that a ball touches, along its contact, without the motion as a whole of
  /// an organ that nothing holds; of a pin, that of its sphere [m].
  double depth = 0;
  std::int32_t contacts = 0;  ///< spheres touched; for a blade, nodes of its edge that tissue holds

  friend bool operator==(const HandReport&, const HandReport&) = default;
};

/// Result of one tick, and of the first hand in it. Never thrown, always complete.
struct StepReport : HandReport {
  StepStatus status = StepStatus::ok;
  std::int32_t worst_sphere = -1;  ///< the sphere that failed or the fastest one; -1: none
  double residual = 0;             ///< of the last solve, relative to its first guess
  std::int32_t iterations = 0;     ///< of all solves of the tick
  /// Substeps that backward Euler did for sdirk2, of first order and with more damping, since its own two stages would
  /// have missed the motion.
  std::int32_t fallbacks = 0;
  std::int32_t severed = 0;     ///< elements, constraints and angle springs severed in this tick
  std::int32_t came_loose = 0;  ///< pieces that came loose in this tick: the increase of their number
  /// Tissue cells that are inside out at the end of the tick (a corner tetrahedron with J < 0); those that a blade cut
  /// do not count. 0 if the Model has no tissue cells.
  std::int32_t inverted = 0;
  std::int32_t asleep = 0;  ///< spheres that slept in the last substep, see Sleepers
  HandReport second;        ///< of the second hand

  HandReport& of_hand(std::size_t hand) { return hand == 0 ? *this : second; }
  const HandReport& of_hand(std::size_t hand) const { return hand == 0 ? *this : second; }
};

/// Why two hands cannot hold these tools at once, as a sentence; empty if they can. `first`, `second`: indices into
/// Model::tools, or -1.
std::string_view hands_conflict(const Model& model, std::int32_t first, std::int32_t second);

/// What a Stepper may use of the machine. No option changes a bit of the result.
struct StepperOptions {
  /// >= 1; more threads help from some thousand spheres on. Cuts that a tool can touch have one of their own.
  int threads = 1;
  elements::InstructionSet instruction_set = elements::best_instruction_set();
  /// Told of the stages of each tick, which begins and ends in Stage::solve; must outlive the Stepper.
  StageWatch* watch = nullptr;
};

/// Advances States of one Model. It holds the kernels of the Model, their scratch memory and the threads, and no
/// simulated state: any State of the Model may be given at any call, in any order. step() allocates scratch memory in
/// the first tick and in the first one with a scalpel, and afterwards only where cuts open or are touched.
class Stepper {
 public:
  /// `model` must outlive the Stepper.
  explicit Stepper(const Model& model, const StepperOptions& options = {});
  ~Stepper();
  Stepper(Stepper&&) noexcept;

  /// Does at once what the first tick with a scalpel would have to do, which may take a tenth of a second.
  void prepare();

  /// One tick. The same Model, State and Inputs give the same bits on every machine.
  StepReport step(State& state, const Inputs& inputs);

  /// Lets the scene come to rest under gravity, without a tool and without Model::loads, for at most `ticks` ticks. It
  /// ends when no sphere is faster than 10^-5 m/s. State::tick does not change.
  StepReport settle(State& state, std::int64_t ticks);

  /// The Model's integrator, and whether it is stable.
  const IntegratorChoice& integrator() const;

 private:
  struct Parts;
  const Model& model_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ctpm::stepping
