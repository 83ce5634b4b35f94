#pragma once

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

/// Compares them. `force_limit` [N]: see CompareOptions. `replaying`: see read_track(). Errors: a damaged session; no
/// tool is ever held.
Result<ComparedFiles> compare_files(OpenedFiles files, std::optional<double> force_limit,
                                    Replaying replaying = Replaying::short_ones);

}  // namespace ctpm::compare
