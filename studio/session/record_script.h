#pragma once

#include <functional>
#include <string>

#include "core/result.h"
#include "recordings/session.h"
#include "scenes/script.h"
#include "studio/loaded_scene.h"
#include "studio/session/run_session.h"

namespace ctpm {

struct RecordOutcome {
  RunOutcome run;
  SessionStatistics statistics;
};

/// Lets the scene come to rest, then runs the script and records it at `path`. Errors: the file exists and
/// `overwrite` is false, it cannot be written.
Result<RecordOutcome> record_script(const LoadedScene& scene, const Script& script, const std::string& path,
                                    bool overwrite, const RunOptions& options);

/// Names the program's version, compiler and kind of build.
std::string build_fingerprint();

}  // namespace ctpm
