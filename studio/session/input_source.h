#pragma once

#include <cstdint>
#include <optional>

#include "core/inputs.h"
#include "core/step.h"

namespace ctpm {

/// Where a session's inputs come from: a script, a file of motion, a device.
class InputSource {
 public:
  virtual ~InputSource() = default;

  /// What the hand does in tick `tick`, knowing what came of the tick before. Nothing: the session is over.
  virtual std::optional<Inputs> next(std::int64_t tick, const StepReport& last) = 0;

  /// Ticks that the session will have, for progress; 0 if nobody knows.
  virtual std::int64_t tick_count() const { return 0; }
};

}  // namespace ctpm
