#include "studio/session/run_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <utility>

#include "core/stepping/step.h"
#include "recordings/state_hash.h"
#include "studio/session/event_watch.h"

namespace ctpm::session {
namespace {

using Clock = std::chrono::steady_clock;

/// Delay that the following ticks make up for [s].
constexpr double kMostDelay = 0.1;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

int threads_for(const Model& model) {
  constexpr std::size_t kWorthSharing = 3000;  // spheres
  return model.sphere_count() >= kWorthSharing && std::thread::hardware_concurrency() > 1 ? 2 : 1;
}

RunOutcome run_session(const Model& model, State& state, sources::InputSource& source,
                       recordings::SessionWriter& writer, const RunOptions& options) {
  stepping::Stepper stepper(model, {.threads = options.threads});
  EventWatch watch(model, options.damage_force, [&](recordings::Event event) { writer.event(std::move(event)); });
  RunOutcome outcome;
  stepping::StepReport report;
  bool is_failing = false;
  const auto tick_length = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(model.tick));
  const Clock::time_point began = Clock::now();
  Clock::time_point deadline = began;  // of the next tick's start, and of the present one's end
  double delay = 0;                    // of the tick before [s]
  for (std::int64_t tick = 0; options.most_ticks == 0 || tick < options.most_ticks; ++tick) {
    if (options.should_stop && options.should_stop()) break;
    if (options.in_real_time) std::this_thread::sleep_until(deadline);
    const std::optional<Inputs> inputs = source.next(tick, report);
    for (recordings::Event& event : source.take_events()) {
      event.tick = tick;
      writer.event(std::move(event));
    }
    if (!inputs) break;
    const Clock::time_point start = Clock::now();
    if (options.in_real_time) {
      const double slip = std::chrono::duration<double>(start - began - tick * tick_length).count();
      outcome.slip = std::floor(1e3 * std::max(0.0, slip)) / 1e3;
    }
    report = stepper.step(state, *inputs);
    const double tick_time = seconds_since(start);
    outcome.status = report.status, outcome.worst_sphere = report.worst_sphere;
    if (stepping::is_refused(report.status)) {
      writer.event({.tick = tick,
                    .kind = recordings::EventKind::step_refused,
                    .status = std::int32_t(report.status),
                    .sphere = report.worst_sphere});
      break;
    }
    const recordings::TickRecord record = recordings::make_record(
        *inputs, report, tick_time, recordings::state_hash(state), source.input_age(), outcome.slip);
    writer.append(state, record);
    watch.look(tick, inputs->tool, report);
    deadline += tick_length;
    if (options.in_real_time) {
      // A tick that catches up ends after its deadline as well, but is not what was late.
      const double before = std::exchange(delay, std::max(0.0, seconds_since(deadline)));
      if (delay > before) {
        ++outcome.late_ticks;
        writer.event({.tick = tick, .kind = recordings::EventKind::late_tick, .late = delay});
      }
      if (delay > kMostDelay) {
        const auto lost =
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(delay - kMostDelay));
        deadline += lost;
        delay = kMostDelay;
      }
    }
    ++outcome.ticks;
    if (writer.has_error() != std::exchange(is_failing, writer.has_error()) && is_failing && options.tell)
      options.tell(writer.status().error);
    if (writer.is_removed()) {
      outcome.fault = writer.status().error;
      break;
    }
    if (options.watch) options.watch(state, record, outcome);
    if (options.progress)
      options.progress(outcome.ticks, options.most_ticks ? options.most_ticks : source.tick_count());
  }
  watch.finish(outcome.ticks);
  if (outcome.fault.empty()) outcome.fault = source.fault();
  return outcome;
}

}  // namespace ctpm::session
