// The page of one trainee: what to do better, where in the stroke, and how the attempts went on.

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "studio/cohort/pages.h"
#include "studio/cohort/stroke_part.h"
#include "studio/compare/measure_table.h"
#include "studio/compare/reach.h"
#include "studio/output/number_text.h"
#include "studio/session/session_info.h"

namespace ctpm::cohort {
namespace {

namespace fs = std::filesystem;
using output::fixed;
using output::short_number;

constexpr int kExpertColour = 0, kTraineeColour = 1, kNeutralColour = 6;
constexpr std::size_t kMostCurves = 8;

std::string with_unit(double value, const compare::Measure& measure) {
  const std::string unit = shown_unit(measure);
  return short_number(value) + (unit.empty() ? "" : " " + unit);
}

reports::Cell percent(std::optional<double> share) {
  return share ? reports::Cell(fixed(100 * *share, 0) + " %") : reports::Cell();
}

/// The latest attempt of everybody else: of a measure, where it has a value.
std::vector<double> values_of_others(const TaskResult& task, const std::string& person, std::size_t measure) {
  std::vector<double> values;
  for (std::size_t i = 0; i < task.attempts.size(); ++i) {
    const bool is_last =
        i + 1 == task.attempts.size() || task.attempts[i + 1].session.person != task.attempts[i].session.person;
    if (is_last && task.attempts[i].session.person != person && task.attempts[i].values[measure].value)
      values.push_back(*task.attempts[i].values[measure].value);
  }
  return values;
}

/// What the latest attempt reached less of than the experts in their mean.
std::vector<compare::Shortfall> shortfalls_of(const TaskResult& task, const Attempt& latest) {
  std::vector<compare::MeasuredValue> values;
  for (std::size_t i = 0; i < latest.values.size(); ++i)
    if (const std::optional<Spread> spread = spread_of(task.expert_values(i)))
      values.push_back({latest.values[i].measure, spread->mean, latest.values[i].value});
  return compare::shortfalls_of(values);
}

/// The latest attempt beside pass marks, experts and everybody else.
reports::Table latest_table(const TaskResult& task, const Attempt& latest) {
  reports::Table table;
  table.columns = {{"measure", "measure"},
                   {"verdict", "pass mark is", 4, true},
                   {"latest", "latest"},
                   {"unit", "unit"},
                   {"mark", "pass mark"},
                   {"mean", "experts' mean"},
                   {"deviation", "spread"},
                   {"deviations", "from the mean, in spreads", 3},
                   {"experts", "experts no better"},
                   {"others", "trainees no better"}};
  const std::vector<compare::Shortfall> shortfalls = shortfalls_of(task, latest);
  for (const std::size_t i : shown_measures(task)) {
    const compare::SessionValue& value = latest.values[i];
    const std::vector<double> experts = task.expert_values(i);
    const std::optional<Spread> spread = spread_of(experts);
    std::vector<reports::Cell> row{std::string(value.measure->title), reports::Cell(), reports::Cell(),
                                   shown_unit(*value.measure), mark_text(task, i)};
    if (!mark_text(task, i).empty())
      row[1] = std::ranges::find(latest.missed, value.measure->key) == latest.missed.end()
                   ? reports::ReportVerdict::met
                   : reports::ReportVerdict::missed;
    row[2] = value.value ? reports::Cell(*value.value) : reports::Cell("no value: " + value.note);
    row.push_back(spread ? reports::Cell(spread->mean) : reports::Cell(std::string("insufficient data")));
    row.push_back(spread ? reports::Cell(spread->deviation) : reports::Cell());
    const bool has_both = spread && value.value;
    row.push_back(has_both && spread->deviation > 0 ? reports::Cell((*value.value - spread->mean) / spread->deviation)
                                                    : reports::Cell());
    const double target = spread ? spread->mean : 0;
    const bool less_done =
        !shortfalls.empty() && value.measure->grows_with_work && has_both && *value.value < spread->mean;
    const auto share = [&](const std::vector<double>& others) {
      if (less_done) return reports::Cell(std::string("less done"));
      return has_both ? percent(share_no_better(*value.value, others, value.measure->direction, target))
                      : reports::Cell();
    };
    row.push_back(share(experts)), row.push_back(share(values_of_others(task, latest.session.person, i)));
    table.rows.push_back(std::move(row));
  }
  table.caption = "Experts: " + std::to_string(task.experts.size()) +
                  " sessions; the spread is their standard deviation. Trainees are compared by their latest attempts.";
  if (!shortfalls.empty())
    table.caption += " Less done: the attempt reached less than the experts (" + to_words(shortfalls) +
                     "), so that a lower value is no better.";
  return without_empty_columns(std::move(table));
}

/// Whether structure `i` of an attempt is structure `i` of an expert. Anonymised sessions hold pseudonyms of the names,
/// and both are of one scene, so that there the order tells it.
bool is_same_structure(const Attempt& attempt, const Attempt& expert, std::size_t i) {
  if (i >= expert.structures.size() || attempt.structures[i].is_zone != expert.structures[i].is_zone) return false;
  if (attempt.structures[i].name == expert.structures[i].name) return true;
  return (attempt.session.is_elapsed || expert.session.is_elapsed) &&
         attempt.structures.size() == expert.structures.size();
}

/// What the latest attempt did to each organ and forbidden zone, beside the experts.
reports::Table structures_table(const TaskResult& task, const Attempt& latest) {
  reports::Table table;
  table.columns = {{"structure", "structure"},          {"time", "time [s]"},           {"time_mean", "experts' mean"},
                   {"peak", "peak force [N]", 4, true}, {"peak_mean", "experts' mean"}, {"impulse", "impulse [N s]"},
                   {"impulse_mean", "experts' mean"},   {"work", "work [mJ]"},          {"work_mean", "experts' mean"}};
  constexpr double kMillijoules = 1e3;
  for (std::size_t i = 0; i < latest.structures.size(); ++i) {
    const compare::StructureLoad& load = latest.structures[i];
    const auto mean = [&](double compare::StructureLoad::*value, double scale) -> reports::Cell {
      std::vector<double> values;
      for (const Attempt& expert : task.experts)
        if (is_same_structure(latest, expert, i)) values.push_back(scale * expert.structures[i].*value);
      const std::optional<Spread> spread = spread_of(values);
      return spread ? reports::Cell(spread->mean) : reports::Cell(std::string("insufficient data"));
    };
    table.rows.push_back({(load.is_zone ? "forbidden: " : "") + load.name, load.seconds,
                          mean(&compare::StructureLoad::seconds, 1), load.peak, mean(&compare::StructureLoad::peak, 1),
                          load.impulse, mean(&compare::StructureLoad::impulse, 1), kMillijoules * load.work,
                          mean(&compare::StructureLoad::work, kMillijoules)});
  }
  table.title = "Each structure";
  table.caption =
      "The time is that with a force on the organ, or with the tool in the zone. The whole force counts for the organ "
      "that the tool touches most.";
  return table;
}

/// Which session each attempt is. The file of an anonymised one may be called after its trainee.
reports::Table attempts_table(const std::vector<const Attempt*>& attempts) {
  reports::Table table;
  table.columns = {{"attempt", "attempt"},
                   {"verdict", "passed", 4, true},
                   {"begun", "begun"},
                   {"duration", "duration [s]"},
                   {"session", "session"}};
  for (const Attempt* attempt : attempts) {
    const FoundSession& session = attempt->session;
    const auto verdict = [&] {
      return *attempt->passed ? reports::ReportVerdict::met : reports::ReportVerdict::missed;
    };
    table.rows.push_back({std::int64_t(session.attempt), attempt->passed ? reports::Cell(verdict()) : reports::Cell(),
                          session.is_elapsed ? reports::Cell() : reports::Cell(session::utc_text(session.begun_s)),
                          attempt->duration_s,
                          session.is_elapsed ? reports::Cell(std::string("anonymised"))
                                             : reports::Cell(fs::path(session.file).filename().string())});
  }
  return without_empty_columns(std::move(table));
}

reports::Series level(const std::string& name, std::size_t count, double value) {
  return {.name = name,
          .x = {1, double(std::max<std::size_t>(2, count))},
          .y = {value, value},
          .stroke = reports::Stroke::dashed,
          .colour = kNeutralColour};
}

/// The values of a measure over the attempts, over the experts' band, within the declared range.
reports::Plot curve_plot(const TaskResult& task, const std::vector<const Attempt*>& attempts, std::size_t measure) {
  const compare::Measure& m = *compare::all_measures()[measure];
  const std::string unit = shown_unit(m);
  reports::Plot plot{.title = m.title, .x_title = "attempt", .y_title = unit.empty() ? "" : "[" + unit + "]"};
  reports::Series line{.name = "", .colour = kTraineeColour},
      marks{.name = "attempts", .stroke = reports::Stroke::marks};
  marks.colour = kTraineeColour;
  for (const Attempt* attempt : attempts)
    if (const auto& value = attempt->values[measure].value)
      for (reports::Series* series : {&line, &marks})
        series->x.push_back(double(attempt->session.attempt)), series->y.push_back(*value);
  plot.series = {line, marks};
  if (const std::optional<Spread> spread = spread_of(task.expert_values(measure)))
    plot.bands = {
        {"experts, one spread", spread->mean - spread->deviation, spread->mean + spread->deviation, kExpertColour}};
  const auto mark = std::ranges::find(task.task.marks, std::string(m.key), &scenes::MarkSpec::measure);
  if (mark != task.task.marks.end()) {
    // Two pass marks of a measure are drawn alike, and have one line in the legend.
    if (mark->pass_at_least) plot.series.push_back(level("pass mark", attempts.size(), *mark->pass_at_least));
    if (mark->pass_at_most)
      plot.series.push_back(level(mark->pass_at_least ? "" : "pass mark", attempts.size(), *mark->pass_at_most));
  }
  show_declared(plot, task, measure);
  plot.x_range = {0.5, double(attempts.size()) + 0.5};
  shape_small(plot, m.rounding);
  return plot;
}

reports::Plot learning_plot(const Learned& learned, const scenes::LearningSpec& learning) {
  const LearningLimits limits = limits_of(learning);
  reports::Plot plot{.title = "Sum of failures", .x_title = "attempt", .y_title = "sum"};
  reports::Series line{.name = "sum", .stroke = reports::Stroke::path, .colour = kTraineeColour};
  for (std::size_t i = 0; i < learned.steps.size(); ++i)
    line.x.push_back(double(i + 1)), line.y.push_back(learned.steps[i].sum);
  plot.series = {line, level("learned below", learned.steps.size(), limits.learned),
                 level("fails too often above", learned.steps.size(), limits.failing)};
  plot.series[2].colour = 1;
  plot.x_range = {0.5, double(learned.steps.size()) + 0.5};
  plot.caption = "A failed attempt adds " + short_number(limits.failure, 3) + ", a passed one takes away " +
                 short_number(limits.pass, 3) + "; at a limit the sum begins at 0 again.";
  shape_small(plot, 0);
  return plot;
}

/// In which forbidden zones an attempt was, and for how long; empty: in none.
std::string zones_text(const Attempt& attempt) {
  std::string text;
  for (const compare::StructureLoad& load : attempt.structures)
    if (load.is_zone && load.seconds > 0)
      text += (text.empty() ? " It was in forbidden zones: " : ", ") + load.name + " for " +
              output::fixed(load.seconds, 2) + " s";
  return text.empty() ? text : text + ".";
}

/// What stands above: of the latest attempt of a task.
std::string verdict_text(const TaskResult& task, const Attempt& latest, const Learned& learned) {
  const std::string which = task.task.name + ", attempt " + std::to_string(latest.session.attempt);
  if (!latest.passed)
    return which + ": measured beside " + std::to_string(task.experts.size()) + " experts." + zones_text(latest);
  std::string text = which + (*latest.passed ? ": passed." : ": not passed.");
  for (std::size_t i = 0; i < std::min<std::size_t>(latest.missed.size(), 3); ++i) {
    const compare::SessionValue& value = latest.value_of(latest.missed[i]);
    const std::size_t measure = std::size_t(&value - latest.values.data());
    text += std::string(i == 0 ? " Missed: " : "; ") + value.measure->title + " (" +
            (value.value ? with_unit(*value.value, *value.measure) : "no value: " + value.note) + ", pass mark " +
            mark_text(task, measure) + ")";
  }
  if (latest.missed.size() > 3) text += " and " + std::to_string(latest.missed.size() - 3) + " more";
  if (!latest.missed.empty()) text += ".";
  text += zones_text(latest);
  if (learned.state == LearningState::open) return text + " Whether it is learned is not yet known.";
  const std::string since = std::to_string(learned.reached);
  return text + (learned.state == LearningState::learned ? " Learned, as of attempt " + since + "."
                                                         : " Too many attempts failed, as of attempt " + since + ".");
}

Result<Done> add_task(reports::Report& report, const Cohort& cohort, const TaskResult& task,
                      const std::vector<const Attempt*>& attempts, const MomentArtist& draw) {
  const Attempt& latest = *attempts.back();
  report.add_heading(task.task.name);
  for (const Attempt* attempt : attempts)
    for (const std::string& remark : attempt->remarks)
      report.add_verdict(false, "Attempt " + std::to_string(attempt->session.attempt) + " " + remark + ".");
  const std::string part = "task-" + std::to_string(&task - cohort.tasks.data() + 1);
  if (Result<Done> added = add_stroke(report, part, task, latest, draw); !added) return added;
  report.add_table(latest_table(task, latest));
  if (latest.structures.size() > 1) report.add_table(structures_table(task, latest));
  std::vector<reports::Plot> curves;
  const Learned learned = learned_of(task, latest.session.person, cohort.course.learning);
  if (!learned.steps.empty()) curves.push_back(learning_plot(learned, cohort.course.learning));
  for (const std::size_t i : shown_measures(task))
    if (curves.size() < kMostCurves) curves.push_back(curve_plot(task, attempts, i));
  report.add_heading(task.task.name + ": " + std::to_string(attempts.size()) +
                     (attempts.size() == 1 ? " attempt" : " attempts"));
  report.add_table(attempts_table(attempts));
  report.add_plots(curves);
  return Done{};
}

}  // namespace

Result<std::string> trainee_page(const Cohort& cohort, std::size_t trainee, const MomentArtist& draw) {
  const std::string& person = cohort.trainees[trainee];
  reports::Report report(person, "Course " + cohort.course.name + ": the latest attempts beside experts.");
  std::vector<std::string> verdicts, points;
  bool any = false, all = true;
  for (const TaskResult& task : cohort.tasks) {
    const std::vector<const Attempt*> attempts = task.attempts_of(person);
    if (attempts.empty()) continue;
    const Attempt& latest = *attempts.back();
    verdicts.push_back(verdict_text(task, latest, learned_of(task, person, cohort.course.learning)));
    for (const StrokeMoment& moment : moments_of(task, latest))
      points.push_back((cohort.tasks.size() > 1 ? task.task.name + ": " : "") + moment.text);
    if (latest.passed) any = true, all = all && *latest.passed;
  }
  points.insert(points.begin(), verdicts.begin() + 1, verdicts.end());
  report.conclude(!any  ? reports::ReportVerdict::shown
                  : all ? reports::ReportVerdict::met
                        : reports::ReportVerdict::missed,
                  verdicts.front(), points);
  add_caveats(report, cohort);
  for (const TaskResult& task : cohort.tasks)
    if (const auto attempts = task.attempts_of(person); !attempts.empty())
      if (const Result<Done> added = add_task(report, cohort, task, attempts, draw); !added) return added.errors();
  report.add_heading("What the measures are");
  report.add_table(meanings(cohort));
  report.add_link("All trainees of the course", "index.html");
  return report.html();
}

}  // namespace ctpm::cohort
