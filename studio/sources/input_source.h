#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/model/inputs.h"
#include "core/stepping/step.h"
#include "recordings/session.h"

namespace ctpm::sources {

/// The source of a session's inputs: a script, a motion file or a device.
class InputSource {
 public:
  virtual ~InputSource() = default;

  /// The inputs of tick `tick`. `last` is the report of the tick before. Called when the tick begins; never waits.
  /// None: the session is over.
  virtual std::optional<Inputs> next(std::int64_t tick, const stepping::StepReport& last) = 0;

  /// Number of ticks of the session, for progress; 0 if unknown.
  virtual std::int64_t tick_count() const { return 0; }

  /// Age of the device sample from which the last next() computed its inputs, at that call [s]; 0 without a device.
  virtual double input_age() const { return 0; }

  /// Events since the last call, with the tick unset; empty in nearly every tick.
  virtual std::vector<recordings::Event> take_events() { return {}; }

  /// Numbers about the whole session, unit in the name; called once, at its end.
  virtual std::vector<recordings::NamedValue> statistics() const { return {}; }

  /// Why the source ended the session early; empty if it did not.
  virtual std::string fault() const { return ""; }
};

}  // namespace ctpm::sources
