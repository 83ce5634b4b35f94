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
#include "studio/session/part_clock.h"
#include "studio/session/urgency.h"

namespace ctpm::session {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// When ticks begin in real time. Those behind a late one follow without a pause until they have caught up.
class TickClock {
 public:
  explicit TickClock(double tick)
      : length_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(tick))) {}

  void wait_for_tick() const { std::this_thread::sleep_until(deadline_); }
  Clock::time_point deadline() const { return deadline_; }

  /// Real time less session time at the start of a tick, in whole milliseconds [s].
  double slip(Clock::time_point start, std::int64_t tick) const {
    const double slip = std::chrono::duration<double>(start - began_ - tick * length_).count();
    return std::floor(1e3 * std::max(0.0, slip)) / 1e3;
  }

  /// Ends a tick. How late it is [s]; 0 if it is not, or if it is less late than the one before, which was what was
  /// late.
  double end_tick() {
    deadline_ += length_;
    const double before = std::exchange(delay_, std::max(0.0, seconds_since(deadline_)));
    const double late = delay_ > before ? delay_ : 0;
    if (delay_ > kMostDelay) {
      deadline_ += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(delay_ - kMostDelay));
      delay_ = kMostDelay;
    }
    return late;
  }

 private:
  static constexpr double kMostDelay = 0.1;  ///< that the following ticks make up for [s]; the rest is lost

  Clock::duration length_;
  Clock::time_point began_ = Clock::now();
  Clock::time_point deadline_ = began_;  ///< of the next tick's start, and of the present one's end
  double delay_ = 0;                     ///< of the tick before [s]
};

/// Tells when recording begins to fail. Returns why it cannot go on; empty if it can.
class FailureWatch {
 public:
  FailureWatch(const recordings::SessionWriter& writer, const std::function<void(const std::string&)>& tell)
      : writer_(writer), tell_(tell) {}
  std::string look() {
    const bool fails = writer_.has_error(), is_new = fails && !is_failing_;
    is_failing_ = fails;
    if (is_new && tell_) tell_(writer_.status().error);
    return writer_.is_removed() ? writer_.status().error : std::string();
  }

 private:
  const recordings::SessionWriter& writer_;
  const std::function<void(const std::string&)>& tell_;
  bool is_failing_ = false;
};

/// Hands the events of the source over, as those of a tick.
void take_events(sources::InputSource& source, std::int64_t tick, recordings::SessionWriter& writer,
                 const RunOptions& options) {
  for (recordings::Event& event : source.take_events()) {
    event.tick = tick;
    if (options.note && event.kind == recordings::EventKind::note) options.note(event.text);
    writer.event(std::move(event));
  }
}

}  // namespace

int threads_for(const Model& model) {
  constexpr std::size_t kWorthSharing = 3000;  // spheres
  return model.sphere_count() >= kWorthSharing && std::thread::hardware_concurrency() > 1 ? 2 : 1;
}

RunOutcome run_session(const Model& model, State& state, sources::InputSource& source,
                       recordings::SessionWriter& writer, const RunOptions& options) {
  std::optional<TickUrgency> urgency;
  if (options.in_real_time) urgency.emplace(model.tick);
  PartClock parts;
  stepping::Stepper stepper(model, {.threads = options.threads, .watch = &parts});
  stepper.prepare();
  EventWatch watch(model, options.damage_force, [&](recordings::Event event) { writer.event(std::move(event)); });
  FailureWatch failure(writer, options.tell);
  RunOutcome outcome;
  stepping::StepReport report;
  TickClock clock(model.tick);
  const double waited_before = thread_wait();
  for (std::int64_t tick = 0; options.most_ticks == 0 || tick < options.most_ticks; ++tick) {
    if (options.should_stop && options.should_stop()) break;
    const Clock::time_point waited = Clock::now();
    if (options.in_real_time) clock.wait_for_tick();
    parts.begin_tick(options.in_real_time ? clock.deadline() : waited, waited);
    const std::optional<Inputs> inputs = source.next(tick, report);
    take_events(source, tick, writer, options);
    if (!inputs) break;
    parts.begin_step();
    if (options.in_real_time) outcome.slip = clock.slip(parts.last(), tick);
    report = stepper.step(state, *inputs);
    parts.begin_recording();
    outcome.lost = parts.lost_in_step();
    outcome.status = report.status, outcome.worst_sphere = report.worst_sphere;
    if (stepping::is_refused(report.status)) {
      writer.event({.tick = tick,
                    .kind = recordings::EventKind::step_refused,
                    .status = std::int32_t(report.status),
                    .sphere = report.worst_sphere});
      break;
    }
    const recordings::TickRecord record = recordings::make_record(
        *inputs, report, parts.step_time(), recordings::state_hash(state), source.input_age(), outcome.slip);
    writer.append(state, record);
    watch.look(tick, *inputs, report);
    if (const double late = options.in_real_time ? clock.end_tick() : 0; late > 0) {
      const recordings::TickParts of = parts.end_tick();
      ++outcome.late_ticks, outcome.late_by.add(recordings::late_cause(of, model.tick));
      writer.event({.tick = tick, .kind = recordings::EventKind::late_tick, .late = late, .parts = of});
    }
    if (urgency) urgency->go_on();
    ++outcome.ticks, outcome.fallbacks += report.fallbacks > 0;
    outcome.fault = failure.look();
    if (!outcome.fault.empty()) break;
    if (options.watch) options.watch(state, record, outcome);
    if (options.progress)
      options.progress(outcome.ticks, options.most_ticks ? options.most_ticks : source.tick_count());
  }
  outcome.waited = thread_wait() - waited_before;
  watch.finish(outcome.ticks);
  if (outcome.fault.empty()) outcome.fault = source.fault();
  return outcome;
}

}  // namespace ctpm::session
