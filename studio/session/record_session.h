#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "core/model/result.h"
#include "recordings/session.h"
#include "scenes/script.h"
#include "studio/loading/loaded_scene.h"
#include "studio/session/run_session.h"
#include "studio/sources/input_source.h"

namespace ctpm::session {

/// Value of a session that was recorded in real time: how long its ticks' thread waited for a processor [s].
inline constexpr const char* kWaited = "waited_for_processor_s";

struct RecordOutcome {
  RunOutcome run;
  recordings::SessionStatistics statistics;
};

/// The start of a session of `scene`, settled to rest. None if `should_stop` ended it. `progress`: see
/// loading::settle_scene().
std::optional<recordings::SessionStart> start_session(
    const loading::LoadedScene& scene, const std::function<bool()>& should_stop,
    const std::function<void(std::int64_t done, std::int64_t most)>& progress = {});
recordings::SessionStart start_session(const loading::LoadedScene& scene);

/// The start of a session that continues the session in `file` from its State at `at_s` [s] and names it as its parent.
/// Errors: the session cannot be read, ends before `at_s`, or does not replay.
Result<recordings::SessionStart> continue_session_at(const std::string& file, double at_s);

/// Runs a session from `start` with the inputs of `source` and records it at `path`. Errors: the file exists and
/// `overwrite` is false; it cannot be written.
Result<RecordOutcome> record_session(const recordings::SessionStart& start, sources::InputSource& source,
                                     const std::string& path, bool overwrite, const RunOptions& options);

/// Settles the scene to rest, runs the script and records it at `path`. Errors: those of record_session().
Result<RecordOutcome> record_script(const loading::LoadedScene& scene, const scenes::Script& script,
                                    const std::string& path, bool overwrite, const RunOptions& options);

}  // namespace ctpm::session
