#pragma once

#include <optional>
#include <utility>

#include "scenes/script.h"
#include "studio/session/input_source.h"

namespace ctpm {

/// A script as the source of a session.
class ScriptSource : public InputSource {
 public:
  explicit ScriptSource(ScriptPlayer player) : player_(std::move(player)) {}

  std::optional<Inputs> next(std::int64_t tick, const StepReport&) override {
    if (tick >= player_.tick_count()) return std::nullopt;
    return player_.at(tick);
  }
  std::int64_t tick_count() const override { return player_.tick_count(); }

 private:
  ScriptPlayer player_;
};

}  // namespace ctpm
