#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/model/inputs.h"
#include "core/stepping/step.h"
#include "recordings/session.h"

namespace ctpm::sources {

/// Where a session's inputs come from: a script, a file of motion, a device.
class InputSource {
 public:
  virtual ~InputSource() = default;

  /// What the hand does in tick `tick`, knowing what came of the tick before. Asked when the tick begins, and
  /// never waits. Nothing: the session is over.
  virtual std::optional<Inputs> next(std::int64_t tick, const stepping::StepReport& last) = 0;

  /// Ticks that the session will have, for progress; 0 if nobody knows.
  virtual std::int64_t tick_count() const { return 0; }

  /// Age of the device's sample behind what next() gave last, at that moment [s]; 0 if there is no device.
  virtual double input_age() const { return 0; }

  /// What was noticed since it was asked last, without its tick; empty in nearly every tick.
  virtual std::vector<recordings::Event> take_events() { return {}; }

  /// Numbers about the whole session, unit in the name; asked once, at its end.
  virtual std::vector<recordings::NamedValue> statistics() const { return {}; }

  /// Why the source ended the session before its time; empty if it did not.
  virtual std::string fault() const { return ""; }
};

}  // namespace ctpm::sources
