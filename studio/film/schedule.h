#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/session/time_range.h"

namespace ctpm::film {

/// Which tick of one session each frame shows.
struct FrameTicks {
  session::TickRange range;  ///< what is shown
  std::int64_t frame_count = 0;
  std::int64_t begun = 0;                                ///< first frame in which the session has begun
  std::int64_t ended = 0;                                ///< first frame after the session's end, or frame_count
  std::function<std::int64_t(std::int64_t frame)> tick;  ///< never decreases; the State before it is shown
  std::function<double(std::int64_t frame)> share;       ///< of the film's speed with which the session goes on
};

struct ScheduleOptions {
  session::TimeRange range;  ///< of the longest session; of the first one where they are matched
  double frame_s = 1;        ///< time of a session from frame to frame [s], > 0
  /// Seconds of two sessions that belong together, neither decreasing. Between two of them the session that is there
  /// sooner is slowed down, so that no half waits and none is faster than it was. Empty: both go by the clock.
  std::vector<std::array<double, 2>> matched;
  /// Parts of a single session that are shown slower, in order and apart: from and to [s].
  std::vector<std::array<double, 2>> slow;
};

/// How many times slower.
inline constexpr double kSlower = 4;

/// The frames of a film of one session, or of two side by side. Errors: a range outside the session.
Result<std::vector<FrameTicks>> schedule(const std::vector<recordings::SessionReader*>& sessions,
                                         const ScheduleOptions& options);

/// The picture of a film of whole sessions in which the first one is at a moment of its own, in seconds; `matched` as
/// above. Errors: a moment outside of the first session.
Result<std::vector<FrameTicks>> schedule_moment(const std::vector<recordings::SessionReader*>& sessions, double at_s,
                                                const std::vector<std::array<double, 2>>& matched);

}  // namespace ctpm::film
