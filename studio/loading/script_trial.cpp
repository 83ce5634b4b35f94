#include "studio/loading/script_trial.h"

#include <time.h>

#include <algorithm>

#include "core/model/nearest_rank.h"

namespace ctpm::loading {
namespace {

/// Ticks between two looks at `should_stop`.
constexpr std::int64_t kStretch = 50;
/// Ticks between two looks at where the spheres are.
constexpr std::int64_t kLook = 20;

/// Of this thread [s].
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

class Trial {
 public:
  Trial(const Model& model, stepping::Stepper& stepper, const State& state, const std::function<bool()>& should_stop)
      : model_(model),
        now_(state),
        stepper_(stepper),
        should_stop_(should_stop),
        mean_(mean_position()),
        seen_(state.swept_organ.size()) {
    trial_.was_cut.assign(model.organs.size(), 0);
  }

  std::optional<ScriptTrial> run(const scenes::Script& script, std::optional<std::size_t> until_cut) {
    scenes::ScriptPlayer player(script, model_.tools, model_.tick);
    for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) {
      if (stops(tick)) return std::nullopt;
      const Inputs inputs = player.at(tick);
      const stepping::StepReport report = step(inputs);
      if (trial_.is_refused) return finished();
      player.feel(tick, report.of_hand(player.hand_at(tick)).tool_force);
      look(report);
      const bool has_blade = model_.is_scalpel(inputs.tool) || model_.is_scalpel(inputs.second.tool);
      if (has_blade) follow(tick, report);
      if (until_cut && !has_blade && trial_.most_force > 0 && trial_.severed > 0 && trial_.was_cut[*until_cut])
        return finished();
    }
    return finished();
  }

 private:
  bool stops(std::int64_t tick) const { return tick % kStretch == 0 && should_stop_ && should_stop_(); }

  void follow(std::int64_t tick, const stepping::StepReport& report) {
    trial_.is_inside_out = trial_.is_inside_out || report.inverted > 0;
    if (tick % kLook == 0) trial_.dragged = std::max(trial_.dragged, norm(mean_position() - mean_));
  }

  Vec3 mean_position() const {
    Vec3 sum;
    for (std::size_t i = 0; i < now_.position.size(); ++i) sum += now_.position[i];
    return sum / double(now_.position.size());
  }

  stepping::StepReport step(const Inputs& inputs) {
    const double start = processor_time();
    const stepping::StepReport report = stepper_.step(now_, inputs);
    const double work = processor_time() - start;
    work_.push_back(work);
    if (report.of_hand(0).contacts > 0 || report.of_hand(1).contacts > 0) busy_.push_back(work);
    trial_.is_refused = stepping::is_refused(report.status);
    return report;
  }

  void look(const stepping::StepReport& report) {
    for (const std::size_t hand : {0, 1})
      trial_.most_force = std::max(trial_.most_force, norm(report.of_hand(hand).tool_force));
    trial_.severed += report.severed;
    if (now_.swept_organ.size() < seen_) seen_ = 0;  // rows of a full memory were let go
    for (; seen_ < now_.swept_organ.size(); ++seen_)
      if (const std::size_t organ = now_.swept_organ[seen_]; organ > 0 && organ <= trial_.was_cut.size())
        trial_.was_cut[organ - 1] = 1;
  }

  ScriptTrial finished() {
    trial_.usual_work = percentile(work_, 0.5), trial_.dearest_work = percentile(busy_, 0.99);
    return trial_;
  }

  const Model& model_;
  State now_;
  stepping::Stepper& stepper_;
  const std::function<bool()>& should_stop_;
  Vec3 mean_;         ///< of all spheres at the start
  std::size_t seen_;  ///< rows of the swept surface that were looked at, times their nodes
  ScriptTrial trial_;
  std::vector<double> work_, busy_;  ///< processor time of all ticks, and of those in contact or in a cut [s]
};

}  // namespace

std::optional<ScriptTrial> try_script(const Model& model, stepping::Stepper& stepper, const State& state,
                                      const scenes::Script& script, std::optional<std::size_t> until_cut,
                                      const std::function<bool()>& should_stop) {
  return Trial(model, stepper, state, should_stop).run(script, until_cut);
}

}  // namespace ctpm::loading
