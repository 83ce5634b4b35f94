#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "scenes/course.h"
#include "studio/cohort/gather.h"
#include "studio/cohort/statistics.h"
#include "studio/cohort/stroke.h"
#include "studio/compare/session_measures.h"

namespace ctpm::cohort {

/// One session as it was measured.
struct Attempt {
  FoundSession session;
  double duration_s = 0;
  std::int32_t physics_revision = 0;
  /// All measures, in the order of compare::all_measures(). Those of a pair are means over the experts, of an expert
  /// over the other ones.
  std::vector<compare::SessionValue> values;
  /// What it did to each organ and forbidden zone; empty: not known.
  std::vector<compare::StructureLoad> structures;
  StrokeCurve curve;                 ///< along the way of the task's middle expert
  std::optional<bool> passed;        ///< every pass mark; unset: the task has none
  std::vector<std::string> missed;   ///< keys of the measures whose pass marks were missed or have no value
  std::vector<std::string> remarks;  ///< caveats, one sentence each
  std::uint64_t motion_hash = 0;     ///< of the tool's ways, forces and depths; a copy under another name has the same

  const compare::SessionValue& value_of(const std::string& key) const;
};

/// A task with everybody who did it.
struct TaskResult {
  scenes::TaskSpec task;
  std::string force_limit_from;            ///< "the course", "the scene", empty: there is none
  std::optional<double> force_limit;       ///< [N]
  std::vector<Attempt> experts, attempts;  ///< attempts: by person and time
  StrokeBand force, deviation;             ///< of the experts [N], [m]
  std::vector<Vec3> middle;                ///< of the experts' ways [m]
  std::size_t middle_expert = 0;           ///< of `experts`, whose way is nearest to those of all others

  /// The experts' values of a measure.
  std::vector<double> expert_values(std::size_t measure) const;
  /// The attempts of one person, in the order of time.
  std::vector<const Attempt*> attempts_of(const std::string& person) const;
  bool has_marks() const;
};

/// A whole cohort.
struct Cohort {
  scenes::CourseSpec course;
  std::vector<TaskResult> tasks;
  std::vector<std::string> trainees;  ///< in the order of their names
  std::vector<std::string> left_out;
  Errors damaged;            ///< trainees' sessions that cannot be read to their end; they are left out as well
  bool is_verified = false;  ///< every session was replayed, and all as they were recorded
};

struct CohortOptions {
  bool verify = false;  ///< replay every session; otherwise recorded forces are believed
  int threads = 2;      ///< >= 1; results do not depend on it
  std::function<void(std::int64_t done, std::int64_t total)> progress = {};
};

/// Measures all sessions of a course. A session of a trainee is forgotten when it has been measured. Errors: those of
/// gather(); damaged sessions of experts, all of them; those of trainees if no other is of a task.
Result<Cohort> measure_cohort(const scenes::CourseSpec& course, const std::string& trainees,
                              const CohortOptions& options);

/// Pass marks that at least half of a task's experts do not meet: whoever is as good as they are fails. A warning each.
Errors find_hard_marks(const TaskResult& task);

/// The same of a whole course, from its experts' sessions alone. Errors: those of gather() that concern them.
CourseFindings find_hard_marks(const scenes::CourseSpec& course);

/// Whether values meet the pass marks of a task; unset if it has none. `missed` gets the keys of those that do not.
std::optional<bool> judge(const std::vector<compare::SessionValue>& values, const scenes::TaskSpec& task,
                          std::vector<std::string>& missed);

/// Share of `others` that are no better than `value`, for the direction of the measure; as "as the expert" counts the
/// distance from `target`. None of nobody.
std::optional<double> share_no_better(double value, const std::vector<double>& others, compare::Direction direction,
                                      double target);

}  // namespace ctpm::cohort
