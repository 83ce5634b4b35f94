#include "studio/loading/script_trial.h"

#include <algorithm>
#include <chrono>

namespace ctpm::loading {
namespace {

/// Ticks between two looks at `should_stop`.
constexpr std::int64_t kStretch = 50;

class Trial {
 public:
  Trial(const Model& model, stepping::Stepper& stepper, const State& state, const std::function<bool()>& should_stop)
      : model_(model), now_(state), stepper_(stepper), should_stop_(should_stop), seen_(state.swept_organ.size()) {
    trial_.was_cut.assign(model.organs.size(), 0);
  }

  std::optional<ScriptTrial> run(const scenes::Script& script, std::optional<std::size_t> until_cut) {
    scenes::ScriptPlayer player(script, model_.tools, model_.tick);
    for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) {
      if (stops(tick)) return std::nullopt;
      const stepping::StepReport report = step(player.at(tick));
      if (trial_.is_refused) return finished();
      player.feel(tick, report.of_hand(player.hand_at(tick)).tool_force);
      look(report);
      if (until_cut && trial_.most_force > 0 && trial_.severed > 0 && trial_.was_cut[*until_cut]) return finished();
    }
    return finished();
  }

 private:
  bool stops(std::int64_t tick) const { return tick % kStretch == 0 && should_stop_ && should_stop_(); }

  stepping::StepReport step(const Inputs& inputs) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    const stepping::StepReport report = stepper_.step(now_, inputs);
    times_.push_back(std::chrono::duration<double>(Clock::now() - start).count());
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
    if (!times_.empty()) {
      const auto middle = times_.begin() + std::ptrdiff_t(times_.size() / 2);
      std::nth_element(times_.begin(), middle, times_.end());
      trial_.tick_time = *middle;
    }
    return trial_;
  }

  const Model& model_;
  State now_;
  stepping::Stepper& stepper_;
  const std::function<bool()>& should_stop_;
  std::size_t seen_;  ///< rows of the swept surface that were looked at, times their nodes
  ScriptTrial trial_;
  std::vector<double> times_;
};

}  // namespace

std::optional<ScriptTrial> try_script(const Model& model, stepping::Stepper& stepper, const State& state,
                                      const scenes::Script& script, std::optional<std::size_t> until_cut,
                                      const std::function<bool()>& should_stop) {
  return Trial(model, stepper, state, should_stop).run(script, until_cut);
}

}  // namespace ctpm::loading
