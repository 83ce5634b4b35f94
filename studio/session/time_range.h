#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/model/result.h"
#include "studio/output/number_text.h"
#include "studio/output/option_name.h"

namespace ctpm::session {

/// Ticks [from, to) of a session.
struct TickRange {
  std::int64_t from = 0, to = 0;
};

/// Part of a session [s].
struct TimeRange {
  double from_s = 0;
  std::optional<double> to_s;  ///< unset: to the end

  /// The ticks of this part. `where` names the session in errors, `tick` [s] is its tick. Errors: the part is empty, or
  /// begins or ends outside the session's `tick_count` ticks.
  Result<TickRange> in_ticks(const std::string& where, double tick, std::int64_t tick_count) const {
    const double end_s = double(tick_count) * tick, last_s = to_s.value_or(end_s);
    const std::string is_long = "the session lasts " + output::short_number(end_s, 6) + " s";
    if (!(from_s >= 0 && from_s <= end_s))
      return Error{
          where, output::option_name("time_range.from_s") + ": got " + output::short_number(from_s, 6) + ", " + is_long,
          ""};
    if (!(last_s > from_s) && tick_count > 0)
      return Error{where,
                   output::option_name("time_range.to_s") + ": got " + output::short_number(last_s, 6) +
                       ", must be after " + output::option_name("time_range.from_s"),
                   ""};
    if (last_s > end_s + 0.5 * tick)
      return Error{where,
                   output::option_name("time_range.to_s") + ": got " + output::short_number(last_s, 6) + ", " + is_long,
                   ""};
    return TickRange{std::llround(from_s / tick), std::llround(last_s / tick)};
  }
};

}  // namespace ctpm::session
