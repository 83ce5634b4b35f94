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
    if (tick > 0) feel(tick - 1, last.tool_force);
    if (tick >= player_.tick_count()) return std::nullopt;
    return player_.at(tick);
  }
  std::int64_t tick_count() const override { return player_.tick_count(); }
  std::vector<recordings::Event> take_events() override { return std::exchange(events_, {}); }

 private:
  void feel(std::int64_t tick, Vec3 force) {
    const scenes::PressEnd end = player_.feel(tick, force);
    if (end == scenes::PressEnd::at_force)
      events_.push_back({.kind = recordings::EventKind::press_reached_force, .force = norm(force)});
    if (end == scenes::PressEnd::at_depth)
      events_.push_back({.kind = recordings::EventKind::press_gave_up, .force = norm(force)});
  }

  scenes::ScriptPlayer player_;
  std::vector<recordings::Event> events_;
};

}  // namespace ctpm::sources
