#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "scenes/script.h"
#include "studio/sources/input_source.h"

namespace ctpm::sources {

/// A script as the source of a session.
class ScriptSource : public InputSource {
 public:
  explicit ScriptSource(scenes::ScriptPlayer player) : player_(std::move(player)) {}

  std::optional<Inputs> next(std::int64_t tick, const stepping::StepReport& last) override {
    if (tick > 0) feel(tick - 1, last);
    if (tick >= player_.tick_count()) return std::nullopt;
    return player_.at(tick);
  }
  std::int64_t tick_count() const override { return player_.tick_count(); }
  std::vector<recordings::Event> take_events() override { return std::exchange(events_, {}); }

 private:
  void feel(std::int64_t tick, const stepping::StepReport& report) {
    const std::size_t hand = player_.hand_at(tick);
    const Vec3 force = report.of_hand(hand).tool_force;
    const auto tell = [&](recordings::EventKind kind) {
      events_.push_back({.kind = kind, .hand = std::int32_t(hand), .force = norm(force)});
    };
    const scenes::PressEnd end = player_.feel(tick, force);
    if (end == scenes::PressEnd::at_force) tell(recordings::EventKind::press_reached_force);
    if (end == scenes::PressEnd::at_depth) tell(recordings::EventKind::press_gave_up);
  }

  scenes::ScriptPlayer player_;
  std::vector<recordings::Event> events_;
};

}  // namespace ctpm::sources
