#pragma once

#include <map>
#include <string>

#include "core/model/result.h"
#include "recordings/session.h"
#include "scenes/script.h"
#include "studio/loading/loaded_scene.h"
#include "studio/session/run_session.h"
#include "studio/sources/input_source.h"

namespace ctpm::session {

struct RecordOutcome {
  RunOutcome run;
  recordings::SessionStatistics statistics;
};

/// The start of a session of `scene`, after it has come to rest.
recordings::SessionStart start_session(const loading::LoadedScene& scene);

/// The start of a session that goes on from the State at `at_s` [s] of the session in `file`, which it names as
/// its parent. Errors: the session cannot be read, does not last so long, or does not replay.
Result<recordings::SessionStart> continue_session_at(const std::string& file, double at_s);

/// Runs a session from `start` with what `source` gives and records it at `path`. Errors: the file exists and
/// `overwrite` is false, it cannot be written.
Result<RecordOutcome> record_session(const recordings::SessionStart& start, sources::InputSource& source,
                                     const std::string& path, bool overwrite, const RunOptions& options);

/// Lets the scene come to rest, then runs the script and records it at `path`. Errors: as for record_session().
Result<RecordOutcome> record_script(const loading::LoadedScene& scene, const scenes::Script& script,
                                    const std::string& path, bool overwrite, const RunOptions& options);

}  // namespace ctpm::session
