#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/compare/measures.h"
#include "studio/reports/report.h"

namespace ctpm::compare {

/// Two sessions and their comparison; all must outlive the report.
struct ComparedSessions {
  const SessionTrack& expert;
  const SessionTrack& trainee;
  const recordings::SessionStart& scene;
  const Comparison& comparison;
};

/// Caveats that a reader must know before trusting the numbers; usually none.
std::vector<std::string> remarks_of(const ComparedSessions& compared);

/// How the trainee's value compares with the expert's: "same" (within 1 % or the measure's rounding), "better",
/// "worse", "differs", "less done" (lower, because the trainee reached less). Empty for measures of the pair.
std::string standing_of(const MeasuredValue& value);

/// What the trainee reached less of than the expert, and what that means for the measures; empty: nothing.
std::string less_done_text(const Comparison& comparison);

/// The whole comparison as JSON: sessions, measures with meaning and source, moments, and the points of the plots.
std::string comparison_json(const ComparedSessions& compared);

/// Seconds of the expert's session at which the tool is where the trainee's is at a moment, as the paths are aligned.
double expert_time_at(const Comparison& comparison, double trainee_s);

/// A worst moment as it looks: the trainee, and the expert at the same place of the path.
struct MomentPictures {
  render::Frame trainee, expert;
};

/// Writes report.html (one self-contained page) and results.json. `pictures`: of the first of the worst moments, at
/// most kShownMoments. `to_see_worst` tells the reader how to see the worst moment; it is not used if there is none.
/// Errors: those of write_report().
Result<Done> write_comparison(const std::string& folder, const ComparedSessions& compared,
                              const std::vector<MomentPictures>& pictures, const std::string& to_see_worst);

}  // namespace ctpm::compare
