#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/replay.h"

namespace ctpm::recordings {

struct RecoverReport {
  bool complete = false;           ///< nothing was missing or damaged
  std::int64_t ticks_saved = 0;    ///< the new file holds ticks [0, ticks_saved)
  std::int64_t ticks_dropped = 0;  ///< readable ticks after the first gap; a replay cannot reach them
  std::int64_t keyframes_saved = 0;
  std::int64_t events_saved = 0;
  std::vector<std::string> losses;   ///< one sentence for each item that could not be saved
  std::vector<std::string> repairs;  ///< one sentence for each item repaired without loss
  Verdict verdict;                   ///< verification of the new file
};

/// Copies every undamaged part of session `in` to a new session `out`, reads `out` back and verifies it. `out` must not
/// exist. Errors: the Model or the initial State cannot be read, or `out` cannot be written. An error leaves no file
/// behind.
Result<RecoverReport> recover_session(const std::string& in, const std::string& out);

}  // namespace ctpm::recordings
