#include "studio/sweep/collect.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "studio/output/option_name.h"
#include "studio/reports/report.h"
#include "studio/reports/sqlite_table.h"

namespace ctpm::sweep {
namespace {

/// One row for each session, whatever became of it. It holds nothing that differs between machines or runs. What varies
/// is there `as_numbers`, or as it is written.
reports::Table results_table(const Collection& collection, bool as_numbers) {
  const Plan& plan = collection.plan;
  reports::Table table;
  table.columns = {{"task", "task"}, {"id", "id"}, {"state", "state"}};
  for (const std::string& column : plan.columns) table.columns.push_back({column, column});
  for (const std::string& measure : collection.measures) table.columns.push_back({measure, measure});
  for (const char* name : {"ticks_hash", "session", "error"}) table.columns.push_back({name, name});
  for (std::size_t i = 0; i < plan.tasks.size(); ++i) {
    const TaskReport& report = collection.reports[i];
    std::vector<reports::Cell> row{std::int64_t(i + 1), plan.tasks[i].id, std::string(to_word(report.state))};
    for (std::size_t k = 0; k < plan.columns.size(); ++k) {
      const std::string& shown = plan.tasks[i].shown[k];
      row.push_back(as_numbers && plan.is_number[k] ? reports::Cell(std::strtod(shown.c_str(), nullptr))
                                                    : reports::Cell(shown));
    }
    for (const std::vector<double>& of_tasks : collection.measured)
      row.push_back(std::isnan(of_tasks[i]) ? reports::Cell() : reports::Cell(of_tasks[i]));
    const bool is_finished = report.state == TaskState::done || report.state == TaskState::failed;
    row.emplace_back(report.result.ticks_hash);
    row.emplace_back(is_finished ? "tasks/" + plan.tasks[i].id + "/session.ctpm" : "");
    row.emplace_back(report.result.error);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::int64_t Collection::count(TaskState state) const {
  return std::count_if(reports.begin(), reports.end(), [&](const TaskReport& report) { return report.state == state; });
}

std::string state_text(const Collection& collection) {
  std::string text =
      std::to_string(collection.count(TaskState::done)) + " of " + std::to_string(collection.reports.size()) + " done";
  for (const TaskState state : {TaskState::failed, TaskState::running, TaskState::killed, TaskState::waiting})
    if (const std::int64_t count = collection.count(state); count > 0)
      text += ", " + std::to_string(count) + " " + to_word(state);
  return text;
}

Result<Collection> look_at_sweep(const std::string& folder) {
  Result<Plan> plan = read_plan(folder);
  if (!plan) return plan.errors();
  Collection collection{std::move(*plan), {}, {}, {}};
  const std::size_t count = collection.plan.tasks.size();
  for (std::size_t i = 0; i < count; ++i) {
    collection.reports.push_back(look_at(folder, collection.plan.tasks[i].id));
    for (const auto& [name, value] : collection.reports.back().result.values) {
      auto found = std::find(collection.measures.begin(), collection.measures.end(), name);
      if (found == collection.measures.end()) {
        found = collection.measures.insert(found, name);
        collection.measured.emplace_back(count, std::numeric_limits<double>::quiet_NaN());
      }
      collection.measured[std::size_t(found - collection.measures.begin())][i] = value;
    }
  }
  return collection;
}

Result<Done> write_results(const Collection& collection, const std::string& folder, bool allow_incomplete) {
  if (!collection.is_complete() && !allow_incomplete)
    return Error{folder, "is incomplete: " + state_text(collection) + "; statistics of it would mislead",
                 output::option_name("collect.incomplete") + " makes them of what is there, and says so"};
  const std::string sqlite = (std::filesystem::path(folder) / "results.sqlite").string();
  if (Result<Done> written = reports::write_sqlite(sqlite, "sessions", results_table(collection, true)); !written)
    return written;
  return reports::write_report(folder, {{"results.csv", reports::to_csv(results_table(collection, false))},
                                        {"report.html", report_page(collection)}});
}

}  // namespace ctpm::sweep
