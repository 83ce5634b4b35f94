#pragma once

#include <chrono>

#include "core/model/stage.h"
#include "recordings/tick_parts.h"

namespace ctpm::session {

/// Measures what the time of each tick goes to, on the thread that runs the ticks. Time in which that thread had no
/// processor is the machine's; but not while it waits for an input or the surface of a cut, which sleep. Other threads
/// of the tick are not looked at.
class PartClock final : public StageWatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// Begins a tick that was due at `due`. The caller did something else until `waited`, and then waited for its start.
  /// Both are the present where ticks are not waited for. Goes on with the input.
  void begin_tick(Clock::time_point due, Clock::time_point waited);

  /// The input is there; begins the step, which tells of its stages.
  void begin_step();
  Stage enter(Stage stage) override;

  /// The step is done; goes on with what records it.
  void begin_recording();

  /// The parts of the tick that ends now.
  recordings::TickParts end_tick();

  /// When the last part ended.
  Clock::time_point last() const { return last_; }
  /// How long the step took, with what the machine took of it [s].
  double step_time() const { return std::chrono::duration<double>(step_end_ - step_start_).count(); }
  /// How much of that the machine took [s].
  double lost_in_step() const { return lost_in_step_; }

 private:
  enum class Part { solver, cut, cut_surface, input, recorder };
  void go_on_with(Part next);
  void look_at_processor();

  recordings::TickParts parts_;
  Part part_ = Part::recorder;
  Stage stage_ = Stage::solve;
  Clock::time_point last_ = Clock::now(), step_start_ = last_, step_end_ = last_;
  double lost_before_step_ = 0, lost_in_step_ = 0;
  // When the thread's processor time was read last, and what it was [s].
  Clock::time_point looked_ = last_;
  double processor_ = 0;
};

}  // namespace ctpm::session
