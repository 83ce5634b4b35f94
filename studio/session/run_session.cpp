#include "studio/session/run_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <utility>

#include "core/stepping/step.h"
#include "recordings/state_hash.h"

namespace ctpm::session {
namespace {

using Clock = std::chrono::steady_clock;

/// Delay that the following ticks make up for [s].
constexpr double kMostDelay = 0.1;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Records events for reviewers: the moments at which something begins or ends.
class EventWatch {
 public:
  EventWatch(const Model& model, double damage_force, recordings::SessionWriter& writer)
      : writer_(writer), force_limit_(damage_force) {
    for (std::size_t i = 0; i < model.organs.size(); ++i) {
      const double limit = model.organs[i].damage_depth;
      if (limit > 0 && (depth_limit_ == 0 || limit < depth_limit_)) depth_limit_ = limit, organ_ = std::int32_t(i);
    }
  }

  void look(std::int64_t tick, std::int32_t tool, const stepping::StepReport& report) {
    if (begins(contact_, tick, report.contacts > 0)) {
      tool_ = tool;
      writer_.event({.tick = tick, .kind = recordings::EventKind::contact_begins, .tool = tool});
    }
    if (ends(contact_, tick))
      writer_.event({.tick = contact_.last_tick, .kind = recordings::EventKind::contact_ends, .tool = tool_});
    if (begins(cut_, tick, report.severed > 0))
      writer_.event({.tick = tick, .kind = recordings::EventKind::cut, .tool = tool, .severed = report.severed});
    ends(cut_, tick);
    if (report.came_loose > 0)
      writer_.event({.tick = tick, .kind = recordings::EventKind::piece_came_loose, .pieces = report.came_loose});
    look_for_damage(tick, report);
    look_for_inversion(tick, report);
  }

  /// Call it after the last tick.
  void finish(std::int64_t end) {
    if (inside_out_.goes_on && inside_out_.last_tick + 1 < end) tell_that_it_came_back();
  }

 private:
  /// A state that persists while it is seen again within kPause. Tissue that follows a retreating tool touches it
  /// intermittently.
  struct Spell {
    bool goes_on = false;
    std::int64_t last_tick = 0;
  };
  static constexpr std::int64_t kPause = 300;  // [ticks]

  static bool begins(Spell& spell, std::int64_t tick, bool is_seen) {
    if (!is_seen) return false;
    const bool is_new = !spell.goes_on;
    spell = {true, tick};
    return is_new;
  }
  static bool ends(Spell& spell, std::int64_t tick) {
    if (!spell.goes_on || tick - spell.last_tick < kPause) return false;
    spell.goes_on = false;
    return true;
  }

  void look_for_damage(std::int64_t tick, const stepping::StepReport& report) {
    if (begins(too_deep_, tick, depth_limit_ > 0 && report.depth > depth_limit_))
      writer_.event({.tick = tick,
                     .kind = recordings::EventKind::damage,
                     .organ = organ_,
                     .depth = report.depth,
                     .depth_limit = depth_limit_});
    ends(too_deep_, tick);
    const double force = norm(report.tool_force);
    if (begins(too_strong_, tick, force_limit_ > 0 && force > force_limit_))
      writer_.event({.tick = tick, .kind = recordings::EventKind::damage, .force = force, .force_limit = force_limit_});
    ends(too_strong_, tick);
  }

  void look_for_inversion(std::int64_t tick, const stepping::StepReport& report) {
    if (begins(inside_out_, tick, report.inverted > 0)) {
      writer_.event({.tick = tick, .kind = recordings::EventKind::turned_inside_out, .cells = report.inverted});
      most_inverted_ = 0;
    }
    most_inverted_ = std::max(most_inverted_, report.inverted);
    if (ends(inside_out_, tick)) tell_that_it_came_back();
  }

  void tell_that_it_came_back() {
    writer_.event(
        {.tick = inside_out_.last_tick + 1, .kind = recordings::EventKind::came_back, .cells = most_inverted_});
  }

  recordings::SessionWriter& writer_;
  double depth_limit_ = 0, force_limit_ = 0;  // [m], [N]; 0: no limit
  std::int32_t organ_ = -1;                   // whose depth limit it is
  std::int32_t tool_ = -1;                    // of the present contact
  std::int32_t most_inverted_ = 0;            // cells in one tick of the present spell
  Spell contact_, cut_, too_deep_, too_strong_, inside_out_;
};

}  // namespace

int threads_for(const Model& model) {
  constexpr std::size_t kWorthSharing = 3000;  // spheres
  return model.sphere_count() >= kWorthSharing && std::thread::hardware_concurrency() > 1 ? 2 : 1;
}

RunOutcome run_session(const Model& model, State& state, sources::InputSource& source,
                       recordings::SessionWriter& writer, const RunOptions& options) {
  stepping::Stepper stepper(model, {.threads = options.threads});
  EventWatch watch(model, options.damage_force, writer);
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
