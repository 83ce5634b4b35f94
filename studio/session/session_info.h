#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"

namespace ctpm::session {

/// What a session says about itself.
struct SessionInfo {
  recordings::SessionStatistics statistics;
  std::vector<recordings::Event> events;  ///< by tick
};

/// Errors: the statistics or the events are damaged.
Result<SessionInfo> read_info(recordings::SessionReader& reader);

/// All of it as JSON.
std::string info_json(const recordings::SessionReader& reader, const SessionInfo& info);

/// A time in seconds since 1970 as "2026-01-31T12:00:00Z".
std::string utc_text(double unix_s);

}  // namespace ctpm::session
