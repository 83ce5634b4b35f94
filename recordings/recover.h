#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/replay.h"

namespace ctpm::recordings {

struct RecoverReport {
  bool complete = false;           ///< nothing was missing or damaged
  std::int64_t ticks_saved = 0;    ///< ticks [0, ticks_saved) are in the new file
  std::int64_t ticks_dropped = 0;  ///< readable ticks after the first gap, which a replay could not reach
  std::int64_t keyframes_saved = 0;
  std::int64_t events_saved = 0;
  std::vector<std::string> losses;   ///< one sentence for each thing that could not be saved
  std::vector<std::string> repairs;  ///< one sentence for each thing that was mended without a loss
  Verdict verdict;                   ///< of the new file, simulated again
};

/// Writes all of session `in` that proves whole to a new session `out`, which must not exist, reads it back
/// and verifies it. Errors: the Model or the initial State cannot be read, or `out` cannot be written;
/// nothing is left behind then.
Result<RecoverReport> recover_session(const std::string& in, const std::string& out);

}  // namespace ctpm::recordings
