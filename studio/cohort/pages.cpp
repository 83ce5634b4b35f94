#include "studio/cohort/pages.h"

#include <algorithm>
#include <optional>
#include <set>

#include "core/parallel/team.h"
#include "studio/cohort/records.h"
#include "studio/compare/measure_table.h"
#include "studio/output/number_text.h"
#include "studio/reports/sqlite_table.h"

namespace ctpm::cohort {
namespace {

using output::short_number;

const std::string kTraineePage = "trainee-";  ///< begins the name of each

const scenes::MarkSpec* mark_of(const TaskResult& task, std::size_t measure) {
  const std::string key = compare::all_measures()[measure]->key;
  const auto found = std::ranges::find(task.task.marks, key, &scenes::MarkSpec::measure);
  return found == task.task.marks.end() ? nullptr : &*found;
}

}  // namespace

void add_caveats(reports::Report& report, const Cohort& cohort) {
  if (cohort.course.evidence.empty())
    report.add_verdict(false,
                       "Not validated: the course names no evidence that these measures and marks tell skill apart.");
  else
    report.add_paragraph("Evidence that the course names: " + cohort.course.evidence);
  report.add_paragraph(cohort.is_verified
                           ? "Every session was replayed as it was recorded; forces and depths are those of the replay."
                           : "Forces and depths are those that the sessions state: they were not verified by replaying "
                             "them.");
}

Learned learned_of(const TaskResult& task, const std::string& person, const scenes::LearningSpec& learning) {
  Learned learned;
  std::vector<bool> passed;
  for (const Attempt* attempt : task.attempts_of(person))
    if (attempt->passed) passed.push_back(*attempt->passed);
  learned.steps = learning_curve(passed, learning);
  for (std::size_t i = 0; i < learned.steps.size(); ++i)
    if (learned.steps[i].state != learned.state) learned.state = learned.steps[i].state, learned.reached = i + 1;
  return learned;
}

const char* to_word(LearningState state) {
  return state == LearningState::learned   ? "learned"
         : state == LearningState::failing ? "fails too often"
                                           : "not yet known";
}

std::vector<std::size_t> shown_measures(const TaskResult& task) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < compare::all_measures().size(); ++i) {
    const auto has_value = [&](const Attempt& attempt) { return attempt.values[i].value.has_value(); };
    const bool any = std::ranges::any_of(task.experts, has_value) || std::ranges::any_of(task.attempts, has_value);
    if (task.task.marks.empty() ? any : mark_of(task, i) != nullptr) shown.push_back(i);
  }
  return shown;
}

std::string mark_text(const TaskResult& task, std::size_t measure) {
  const scenes::MarkSpec* mark = mark_of(task, measure);
  if (mark == nullptr) return "";
  if (mark->pass_at_least && mark->pass_at_most)
    return short_number(*mark->pass_at_least) + " to " + short_number(*mark->pass_at_most);
  if (mark->pass_at_least) return "at least " + short_number(*mark->pass_at_least);
  return mark->pass_at_most ? "at most " + short_number(*mark->pass_at_most) : "";
}

std::string shown_unit(const compare::Measure& measure) {
  const std::string unit = measure.unit;
  return unit == "1" ? "" : unit;
}

void show_declared(reports::Plot& plot, const TaskResult& task, std::size_t measure) {
  const scenes::MarkSpec* mark = mark_of(task, measure);
  if (mark == nullptr || !mark->low || !mark->high) return;
  double low = *mark->low, high = *mark->high;
  for (const reports::Series& series : plot.series)
    for (const double y : series.y) low = std::min(low, y), high = std::max(high, y);
  plot.y_range = {low, high};
}

void shape_small(reports::Plot& plot, double rounding) {
  constexpr double kLeast = 1e-6;
  plot.width = 360, plot.height = 250;
  plot.counts_x = true, plot.least_y_span = std::max(2 * rounding, kLeast);
}

reports::Table meanings(const Cohort& cohort) {
  std::set<std::size_t> shown;
  for (const TaskResult& task : cohort.tasks)
    for (const std::size_t i : shown_measures(task)) shown.insert(i);
  reports::Table table;
  table.columns = {{"measure", "measure"}, {"better_is", "better is"}, {"meaning", "what it is"}, {"source", "source"}};
  for (const std::size_t i : shown) {
    const compare::Measure& m = *compare::all_measures()[i];
    table.rows.push_back(
        {std::string(m.title), std::string(to_word(m.direction)), std::string(m.meaning), std::string(m.source)});
  }
  table.caption = "Measures of two sessions are means over the experts, and those of an expert over the other experts.";
  return table;
}

std::string page_name(const Cohort& cohort, std::size_t trainee) {
  const auto plain = [](const std::string& name) {
    std::string text = name;
    for (char& c : text)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
    return text.substr(0, 60);
  };
  // Two names may be the same once they are plain.
  std::size_t same = 0;
  for (std::size_t i = 0; i < trainee; ++i) same += plain(cohort.trainees[i]) == plain(cohort.trainees[trainee]);
  return kTraineePage + plain(cohort.trainees[trainee]) + (same > 0 ? "." + std::to_string(same + 1) : "") + ".html";
}

Result<Done> write_cohort(const Cohort& cohort, const std::string& folder, const std::string& home,
                          const MomentArtist& draw, int threads) {
  const reports::Table rows = long_table(cohort);
  std::vector<reports::ReportFile> files{{kFirstPage, educator_page(cohort)},
                                         {"results.csv", reports::to_csv(rows)},
                                         {"statements.jsonl", statements(cohort, home)}};
  // Each picture takes a replay of its own.
  std::vector<std::optional<Result<std::string>>> pages(cohort.trainees.size());
  parallel::Team(threads).for_each(int(pages.size()),
                                   [&](int i) { pages[std::size_t(i)] = trainee_page(cohort, std::size_t(i), draw); });
  for (std::size_t i = 0; i < pages.size(); ++i) {
    if (!*pages[i]) return pages[i]->errors();
    files.push_back({page_name(cohort, i), std::move(**pages[i])});
  }
  if (Result<Done> written = reports::write_sqlite(folder + "/results.sqlite", "result", rows); !written)
    return written;
  if (Result<Done> written = reports::write_report(folder, files, kFirstPage); !written) return written;
  reports::remove_old_pages(folder, kTraineePage, files);  // those of trainees who have left
  return Done{};
}

}  // namespace ctpm::cohort
