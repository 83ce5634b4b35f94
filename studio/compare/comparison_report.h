#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/compare/measures.h"

namespace ctpm {

/// Two sessions and what came of comparing them; all must outlive the report.
struct ComparedSessions {
  const SessionTrack& expert;
  const SessionTrack& trainee;
  const SessionStart& scene;
  const Comparison& comparison;
};

/// What a reader must know before trusting the numbers; mostly nothing.
std::vector<std::string> remarks_of(const ComparedSessions& compared);

/// The measures and the worst moments as lines for a terminal.
std::string comparison_text(const ComparedSessions& compared);

/// Everything for programs: sessions, measures with meaning and source, moments, and the points of the plots.
std::string comparison_json(const ComparedSessions& compared);

/// Writes report.html (one page that loads nothing from elsewhere) and results.json. Errors: those of
/// write_report.
Result<Done> write_comparison(const std::string& folder, const ComparedSessions& compared);

}  // namespace ctpm
