#include "studio/session/run_session.h"

#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include "core/stepping/step.h"
#include "recordings/state_hash.h"

namespace ctpm {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Notes what a reviewer wants to find again: the moments at which something begins or ends.
class EventWatch {
 public:
  EventWatch(const Model& model, double damage_force, SessionWriter& writer)
      : writer_(writer), most_force_(damage_force) {
    for (const OrganRange& organ : model.organs)
      if (organ.damage_depth > 0 && (most_depth_ == 0 || organ.damage_depth < most_depth_))
        most_depth_ = organ.damage_depth;
  }

  void look(std::int64_t tick, const StepReport& report) {
    if (begins(contact_, tick, report.contacts > 0))
      writer_.event(tick, EventKind::contact_begins, "tool touches the tissue");
    if (ends(contact_, tick)) writer_.event(contact_.last_tick, EventKind::contact_ends, "tool leaves the tissue");
    if (begins(cut_, tick, report.severed > 0))
      writer_.event(tick, EventKind::cut, "blade begins to sever; value: elements", {double(report.severed)});
    ends(cut_, tick);
    if (report.came_loose > 0) writer_.event(tick, EventKind::cut, piece_came_loose, {double(report.came_loose)});
    if (begins(too_deep_, tick, most_depth_ > 0 && report.depth > most_depth_))
      writer_.event(tick, EventKind::damage, "depth passes the damage limit; values: depth and limit in m",
                    {report.depth, most_depth_});
    ends(too_deep_, tick);
    const double force = norm(report.tool_force);
    if (begins(too_strong_, tick, most_force_ > 0 && force > most_force_))
      writer_.event(tick, EventKind::damage, "force passes the damage limit; values: force and limit in N",
                    {force, most_force_});
    ends(too_strong_, tick);
  }

 private:
  /// Something that goes on while it is seen again within kPause; tissue that follows a leaving tool touches
  /// it on and off.
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

  SessionWriter& writer_;
  double most_depth_ = 0, most_force_ = 0;  // [m], [N]; 0: no limit
  Spell contact_, cut_, too_deep_, too_strong_;
};

}  // namespace

std::int64_t pieces_came_loose(const std::vector<Event>& events, std::int64_t end) {
  double pieces = 0;
  for (const Event& event : events)
    if (event.tick < end && event.kind == EventKind::cut && event.text == piece_came_loose && !event.values.empty())
      pieces += event.values[0];
  return std::int64_t(pieces);
}

int threads_for(const Model& model) {
  constexpr std::size_t kWorthSharing = 3000;  // spheres
  return model.sphere_count() >= kWorthSharing && std::thread::hardware_concurrency() > 1 ? 2 : 1;
}

RunOutcome run_session(const Model& model, State& state, InputSource& source, SessionWriter& writer,
                       const RunOptions& options) {
  Stepper stepper(model, {.threads = options.threads});
  EventWatch watch(model, options.damage_force, writer);
  RunOutcome outcome;
  StepReport report;
  const auto tick_length = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(model.tick));
  Clock::time_point deadline = Clock::now();
  for (std::int64_t tick = 0; options.most_ticks == 0 || tick < options.most_ticks; ++tick) {
    if (options.should_stop && options.should_stop()) break;
    if (options.in_real_time) std::this_thread::sleep_until(deadline);
    const std::optional<Inputs> inputs = source.next(tick, report);
    for (SourceEvent& event : source.take_events())
      writer.event(tick, event.kind, std::move(event.text), std::move(event.values));
    if (!inputs) break;
    const Clock::time_point start = Clock::now();
    report = stepper.step(state, *inputs);
    const double tick_time = seconds_since(start);
    outcome.status = report.status, outcome.worst_sphere = report.worst_sphere;
    if (is_refused(report.status)) {
      writer.event(tick, EventKind::note, "the step was refused; value: sphere", {double(report.worst_sphere)});
      break;
    }
    writer.append(state, make_record(*inputs, report, tick_time, state_hash(state), source.input_age()));
    watch.look(tick, report);
    deadline += tick_length;
    if (options.in_real_time && Clock::now() > deadline) {
      ++outcome.late_ticks;
      writer.event(tick, EventKind::late_tick, "tick ended late; value: by how much in s", {seconds_since(deadline)});
      deadline = Clock::now();  // a late tick does not make the next ones hurry
    }
    ++outcome.ticks;
    if (options.progress)
      options.progress(outcome.ticks, options.most_ticks ? options.most_ticks : source.tick_count());
  }
  outcome.fault = source.fault();
  return outcome;
}

}  // namespace ctpm
