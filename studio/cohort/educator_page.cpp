// The page of everybody: who has learned what, which mark is the hardest, and how the cohort went on.

#include <algorithm>
#include <map>

#include "studio/cohort/pages.h"
#include "studio/compare/measure_table.h"
#include "studio/output/number_text.h"

namespace ctpm::cohort {
namespace {

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

using output::fixed;
using output::short_number;

constexpr int kExpertColour = 0, kTraineeColour = 1;
constexpr std::size_t kMostCurves = 8;

/// Who has done the task.
std::vector<std::size_t> people_of(const Cohort& cohort, const TaskResult& task) {
  std::vector<std::size_t> people;
  for (std::size_t i = 0; i < cohort.trainees.size(); ++i)
    if (!task.attempts_of(cohort.trainees[i]).empty()) people.push_back(i);
  return people;
}

std::string names_of_missed(const Attempt& attempt) {
  std::string names;
  for (const std::string& key : attempt.missed)
    names += (names.empty() ? "" : ", ") + std::string(attempt.value_of(key).measure->title);
  return names;
}

reports::Table people_table(const Cohort& cohort, const TaskResult& task) {
  reports::Table table;
  table.columns = {{"trainee", "trainee"},
                   {"state", "state", 4, true},
                   {"attempts", "attempts"},
                   {"latest", "latest attempt"},
                   {"passed", "passed"},
                   {"reached", "state since attempt"},
                   {"missed", "missed in the latest"}};
  for (const std::size_t i : people_of(cohort, task)) {
    const std::vector<const Attempt*> attempts = task.attempts_of(cohort.trainees[i]);
    const Learned learned = learned_of(task, cohort.trainees[i], cohort.course.learning);
    const Attempt& latest = *attempts.back();
    std::vector<reports::Cell> row{reports::Link{cohort.trainees[i], page_name(cohort, i)}};
    row.push_back(task.has_marks() ? reports::Cell(std::string(to_word(learned.state))) : reports::Cell());
    row.push_back(std::int64_t(attempts.size()));
    row.push_back(latest.passed
                      ? reports::Cell(*latest.passed ? reports::ReportVerdict::met : reports::ReportVerdict::missed)
                      : reports::Cell());
    const auto passed = std::ranges::count_if(attempts, [](const Attempt* a) { return a->passed.value_or(false); });
    row.push_back(latest.passed ? reports::Cell(std::int64_t(passed)) : reports::Cell());
    row.push_back(learned.reached > 0 ? reports::Cell(std::int64_t(learned.reached)) : reports::Cell());
    row.push_back(names_of_missed(latest));
    table.rows.push_back(std::move(row));
  }
  return without_empty_columns(std::move(table));
}

std::string interval_text(const std::vector<double>& values, const scenes::IntervalSpec& how) {
  const std::optional<Spread> spread = spread_of(values);
  if (spread && !(spread->deviation > 0)) return "";  // drawn again, equal values tell nothing
  const std::optional<Interval> interval = interval_of_mean(values, how);
  return interval ? short_number(interval->low, 3) + " to " + short_number(interval->high, 3) : "";
}

/// Of one value that value; empty: there is none.
reports::Cell mean_of(const std::vector<double>& values) {
  if (values.size() == 1) return values[0];
  const std::optional<Spread> spread = spread_of(values);
  return spread ? reports::Cell(spread->mean) : reports::Cell();
}

/// The experts' band, and where the trainees' latest attempts are.
reports::Table band_table(const Cohort& cohort, const TaskResult& task) {
  const std::string confidence = fixed(100 * cohort.course.intervals.confidence, 0) + " %";
  reports::Table table;
  table.columns = {{"measure", "measure"},
                   {"unit", "unit"},
                   {"experts", "experts"},
                   {"mean", "experts' mean"},
                   {"deviation", "spread"},
                   {"interval", confidence + " interval"},
                   {"trainees", "trainees"},
                   {"latest", "trainees' mean"},
                   {"latest_interval", confidence + " interval"},
                   {"mark", "pass mark"}};
  for (const std::size_t i : shown_measures(task)) {
    const compare::Measure& m = *compare::all_measures()[i];
    const std::vector<double> experts = task.expert_values(i);
    std::vector<double> latest;
    for (const std::size_t person : people_of(cohort, task))
      if (const auto& value = task.attempts_of(cohort.trainees[person]).back()->values[i].value)
        latest.push_back(*value);
    const std::optional<Spread> band = spread_of(experts);
    table.rows.push_back({std::string(m.title), shown_unit(m), std::int64_t(experts.size()),
                          band ? reports::Cell(band->mean) : reports::Cell(std::string("insufficient data")),
                          band ? reports::Cell(band->deviation) : reports::Cell(),
                          interval_text(experts, cohort.course.intervals), std::int64_t(latest.size()), mean_of(latest),
                          interval_text(latest, cohort.course.intervals), mark_text(task, i)});
  }
  table.caption =
      "Intervals of means: " + std::to_string(cohort.course.intervals.resamples) + " bootstrap samples with the seed " +
      std::to_string(cohort.course.intervals.seed) +
      "; of few values they are too narrow, and of one or of equal ones there is none. Trainees are counted with their "
      "latest "
      "attempts.";
  return without_empty_columns(std::move(table));
}

/// The mean of all trainees in their first, second ... attempt, with its interval, over the experts' band.
reports::Plot cohort_curve(const Cohort& cohort, const TaskResult& task, std::size_t measure) {
  const compare::Measure& m = *compare::all_measures()[measure];
  std::map<std::size_t, std::vector<double>> by_attempt;
  for (const Attempt& attempt : task.attempts)
    if (const auto& value = attempt.values[measure].value) by_attempt[attempt.session.attempt].push_back(*value);
  const std::string unit = shown_unit(m);
  reports::Plot plot{.title = m.title, .x_title = "attempt", .y_title = unit.empty() ? "" : "[" + unit + "]"};
  reports::Series all{.name = "attempts", .stroke = reports::Stroke::marks, .colour = 5},
      mean{.name = "mean", .colour = kTraineeColour},
      low{.name = "its interval", .stroke = reports::Stroke::dashed, .colour = kTraineeColour}, high = low;
  high.name = "";
  for (const auto& [attempt, values] : by_attempt) {
    for (const double value : values) all.x.push_back(double(attempt)), all.y.push_back(value);
    const std::optional<Interval> interval = interval_of_mean(values, cohort.course.intervals);
    if (!interval) continue;
    mean.x.push_back(double(attempt)), mean.y.push_back(spread_of(values)->mean);
    low.x.push_back(double(attempt)), low.y.push_back(interval->low);
    high.x.push_back(double(attempt)), high.y.push_back(interval->high);
  }
  plot.series = {all, mean, low, high};
  if (const std::optional<Spread> spread = spread_of(task.expert_values(measure)))
    plot.bands = {
        {"experts, one spread", spread->mean - spread->deviation, spread->mean + spread->deviation, kExpertColour}};
  show_declared(plot, task, measure);
  plot.x_range = {0.5, (by_attempt.empty() ? 1.0 : double(by_attempt.rbegin()->first)) + 0.5};
  shape_small(plot, m.rounding);
  return plot;
}

/// How many have learned a task, and what most of them miss.
std::string task_text(const Cohort& cohort, const TaskResult& task) {
  const std::vector<std::size_t> people = people_of(cohort, task);
  const std::string of_all = " of " + counted(people.size(), "trainee") + " ";
  if (people.empty()) return task.task.name + ": nobody has tried it.";
  if (!task.has_marks())
    return task.task.name + ": " + counted(task.attempts.size(), "attempt") + " of " +
           counted(people.size(), "trainee") + " beside " + std::to_string(task.experts.size()) +
           " experts; it has no pass marks.";
  std::size_t learned = 0, passed = 0;
  std::map<std::string, std::size_t> missed;
  for (const std::size_t person : people) {
    learned += learned_of(task, cohort.trainees[person], cohort.course.learning).state == LearningState::learned;
    const Attempt& latest = *task.attempts_of(cohort.trainees[person]).back();
    passed += latest.passed.value_or(false);
    for (const std::string& key : latest.missed) ++missed[latest.value_of(key).measure->title];
  }
  std::string text = task.task.name + ": " + std::to_string(learned) + of_all + (learned == 1 ? "has" : "have") +
                     " learned it, " + std::to_string(passed) + " passed in the latest attempt.";
  const auto most = std::ranges::max_element(missed, {}, [](const auto& entry) { return entry.second; });
  if (most != missed.end())
    text += " Missed most often: " + most->first + " (" + std::to_string(most->second) + " of " +
            std::to_string(people.size()) + ").";
  return text;
}

}  // namespace

std::string educator_page(const Cohort& cohort) {
  reports::Report report("Course " + cohort.course.name, counted(cohort.trainees.size(), "trainee") + ", " +
                                                             std::to_string(cohort.tasks.size()) +
                                                             (cohort.tasks.size() == 1 ? " task." : " tasks."));
  std::vector<std::string> points;
  for (const TaskResult& task : cohort.tasks) points.push_back(task_text(cohort, task));
  const std::string first = points.front();
  points.erase(points.begin());
  if (!cohort.left_out.empty())
    points.push_back(counted(cohort.left_out.size(), "session") + (cohort.left_out.size() == 1
                                                                       ? " belongs to no task and is left out."
                                                                       : " belong to no task and are left out."));
  if (!cohort.damaged.empty())
    points.push_back(counted(cohort.damaged.size(), "session") + " cannot be read and " +
                     (cohort.damaged.size() == 1 ? "is" : "are") + " left out.");
  report.conclude(reports::ReportVerdict::shown, first, points);
  add_caveats(report, cohort);
  for (const TaskResult& task : cohort.tasks) {
    report.add_heading(task.task.name);
    if (!task.attempts.empty()) report.add_table(people_table(cohort, task));
    report.add_heading(task.task.name + ": experts and trainees");
    report.add_table(band_table(cohort, task));
    std::vector<reports::Plot> curves;
    for (const std::size_t i : shown_measures(task))
      if (curves.size() < kMostCurves && !task.attempts.empty()) curves.push_back(cohort_curve(cohort, task, i));
    report.add_plots(curves);
    for (const Attempt& expert : task.experts)
      for (const std::string& remark : expert.remarks)
        report.add_verdict(false, expert.session.file + " " + remark + ".");
  }
  if (!cohort.left_out.empty() || !cohort.damaged.empty()) report.add_heading("Left out");
  for (const std::string& text : cohort.left_out) report.add_paragraph(text + ".");
  for (const Error& damage : cohort.damaged) report.add_paragraph(to_string(damage) + ".");
  report.add_heading("What the measures are");
  report.add_table(meanings(cohort));
  return report.html();
}

}  // namespace ctpm::cohort
