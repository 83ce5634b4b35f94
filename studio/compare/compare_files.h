#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/compare/measures.h"
#include "studio/compare/report.h"

namespace ctpm::compare {

/// Two session files and their comparison.
struct ComparedFiles {
  recordings::SessionReader expert, trainee;
  SessionTrack expert_track, trainee_track;
  Comparison comparison;

  ComparedSessions sessions() const { return {expert_track, trainee_track, expert.start(), comparison}; }
};

/// Opens two session files. Errors: those of both files; the sessions are of two scenes.
struct OpenedFiles {
  recordings::SessionReader expert, trainee;
};
Result<OpenedFiles> open_files(const std::string& expert, const std::string& trainee);

struct CompareFilesOptions {
  std::optional<double> force_limit;  ///< [N], see CompareOptions
  Replaying replaying = Replaying::short_ones;
  /// That the session was replayed before, and all of its ticks were as recorded: it counts as verified.
  bool is_expert_known = false, is_trainee_known = false;
  std::function<void(std::int64_t done, std::int64_t total)> progress = {};  ///< in ticks of both; one call at a time
  std::function<bool()> should_stop = {};                                    ///< asked by two threads
};
/// Compares them. Errors: a damaged session; no tool is ever held; `should_stop` ended it.
Result<ComparedFiles> compare_files(OpenedFiles files, const CompareFilesOptions& options = {});

}  // namespace ctpm::compare
