#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "recordings/event.h"
#include "recordings/tick_parts.h"

namespace ctpm::session {

/// Late ticks, counted by what made them late.
class LateTicks {
 public:
  void add(recordings::LateCause cause) { ++counts_[std::size_t(cause)]; }
  std::int64_t of(recordings::LateCause cause) const { return counts_[std::size_t(cause)]; }
  std::int64_t total() const;

  /// "cut 12, machine 3", the most frequent first; empty if none was late.
  std::string text() const;

  friend bool operator==(const LateTicks&, const LateTicks&) = default;

 private:
  std::array<std::int64_t, recordings::kLateCauses.size()> counts_{};
};

/// Those among the events of a session with ticks of `tick` [s].
LateTicks late_ticks_of(const std::vector<recordings::Event>& events, double tick);

/// What a cause means, for whoever reads text().
inline constexpr const char* kLateCausesSay =
    "without machine, recorder, input and cut, in this order, a tick would have been in time: it is counted where it "
    "first would";

}  // namespace ctpm::session
