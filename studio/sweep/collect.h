#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/sweep/plan.h"
#include "studio/sweep/task_folder.h"

namespace ctpm::sweep {

/// All that is known of a sweep.
struct Collection {
  Plan plan;
  std::vector<TaskReport> reports;            ///< (task_count)
  std::vector<std::string> measures;          ///< names of all values of results, in their order
  std::vector<std::vector<double>> measured;  ///< NaN: none (measure_count x task_count)

  std::int64_t count(TaskState state) const;
  bool is_complete() const { return count(TaskState::done) == std::int64_t(plan.tasks.size()); }
};

/// Reads the results of a sweep's folder. Errors: there is no plan.
Result<Collection> look_at_sweep(const std::string& folder);

/// "187 of 200 done, 3 failed, 10 waiting"
std::string state_text(const Collection& collection);

/// Writes results.csv, results.sqlite and report.html to the sweep's folder. Errors: the sweep is incomplete and
/// `allow_incomplete` is false, named by the option "collect.incomplete"; a file cannot be written.
Result<Done> write_results(const Collection& collection, const std::string& folder, bool allow_incomplete);

/// What write_results() writes as report.html.
std::string report_page(const Collection& collection);

}  // namespace ctpm::sweep
