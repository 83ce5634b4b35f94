#include "studio/session/part_clock.h"

#include <algorithm>
#include <utility>

#include "studio/session/urgency.h"

namespace ctpm::session {
namespace {

using Clock = PartClock::Clock;

/// Processor time is read only after parts that took longer [s]: it costs half a microsecond, and what puts a thread
/// aside for less makes no tick late.
constexpr double kWorthALook = 50e-6;

double between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void PartClock::look_at_processor() { looked_ = last_, processor_ = thread_time(); }

void PartClock::begin_tick(Clock::time_point due, Clock::time_point waited) {
  // A tick that follows a late one is due when that ended: its time is its own.
  const Clock::time_point start = std::max(due, last_), now = Clock::now();
  parts_ = {};
  parts_.recorder = std::max(0.0, between(start, waited));
  parts_.machine = std::max(0.0, between(std::max(start, waited), now));
  last_ = now, part_ = Part::input;
  look_at_processor();
}

void PartClock::begin_step() {
  stage_ = Stage::solve;
  go_on_with(Part::solver);
  step_start_ = last_, lost_before_step_ = parts_.machine;
}

Stage PartClock::enter(Stage stage) {
  go_on_with(stage == Stage::solve ? Part::solver : stage == Stage::cut ? Part::cut : Part::cut_surface);
  return std::exchange(stage_, stage);
}

void PartClock::begin_recording() {
  go_on_with(Part::recorder);
  step_end_ = last_, lost_in_step_ = parts_.machine - lost_before_step_;
}

recordings::TickParts PartClock::end_tick() {
  go_on_with(Part::recorder);
  return parts_;
}

/// Ends the present part.
void PartClock::go_on_with(Part next) {
  const Clock::time_point now = Clock::now();
  const double took = between(last_, now);
  last_ = now;
  double lost = 0;
  if (took > kWorthALook) {
    const double before = processor_, away = between(looked_, now);
    look_at_processor();
    const bool sleeps = part_ == Part::input || part_ == Part::cut_surface;
    if (!sleeps) lost = std::clamp(away - (processor_ - before), 0.0, took);
  }
  double& seconds = part_ == Part::solver     ? parts_.solver
                    : part_ == Part::input    ? parts_.input
                    : part_ == Part::recorder ? parts_.recorder
                                              : parts_.cut;
  seconds += took - lost, parts_.machine += lost;
  part_ = next;
}

}  // namespace ctpm::session
