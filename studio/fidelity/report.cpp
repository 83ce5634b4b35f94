// The page: goals first, then what each recipe found.

#include <algorithm>
#include <cmath>

#include "studio/fidelity/fidelity.h"
#include "studio/output/number_text.h"
#include "studio/reports/report.h"

namespace ctpm::fidelity {
namespace {

reports::Cell cell(double value) { return std::isfinite(value) ? reports::Cell(value) : reports::Cell(); }

/// What a reader of the page needs of the figures of one chapter; results.csv has them all.
reports::Table goals_of(const Chapter& chapter) {
  reports::Table table;
  table.columns = {{"name", "figure"},
                   {"verdict", "verdict"},
                   {"measured", "measured"},
                   {"unit", "unit"},
                   {"goal", "goal"},
                   {"reference", "reference"},
                   {"error_percent", "error [%]", 3},
                   {"radius_mm", "r [mm]", 3},
                   {"source", "reference from"}};
  for (const Figure& f : chapter.figures)
    table.rows.push_back({f.name + (f.note.empty() ? "" : " (" + f.note + ")"), f.verdict(), cell(f.measured),
                          f.unit == "1" ? std::string() : f.unit, f.goal ? f.goal->text(f.unit) : std::string(),
                          f.reference ? cell(*f.reference) : reports::Cell(), cell(100 * f.error()),
                          f.radius > 0 ? reports::Cell(1e3 * f.radius) : reports::Cell(), f.source});
  return without_empty_columns(std::move(table));
}

std::string subtitle_of(const FidelityResults& results) {
  const std::string bodies =
      results.scene
          ? "The first organ of " + *results.scene +
                " under its first ball, against what an organ without a lattice would do."
          : "Bodies of the paper's liver (E0 = 39.3 kPa, Poisson's ratio 1/4) are meshed, filled and built as "
            "an author's scene is, and compared with finite elements, closed forms and plain requirements. The gap "
            "between spheres is their radius r.";
  return bodies + (results.is_quick ? " Short form: coarse fillings, few places and turns." : "");
}

/// How many goals each recipe meets.
reports::Table overview(const FidelityResults& results) {
  reports::Table table;
  table.columns = {{"recipe", "recipe"}, {"verdict", "verdict"}, {"met", "goals met"}, {"missed", "goals missed"}};
  for (const Chapter& chapter : results.chapters) {
    std::int64_t met = 0, missed = 0;
    for (const Figure& figure : chapter.figures) {
      met += figure.verdict() == reports::ReportVerdict::met;
      missed += figure.verdict() == reports::ReportVerdict::missed;
    }
    const reports::ReportVerdict verdict = missed > 0 ? reports::ReportVerdict::missed
                                           : met > 0  ? reports::ReportVerdict::met
                                                      : reports::ReportVerdict::shown;
    table.rows.push_back({chapter.section.title, verdict, met, missed});
  }
  return table;
}

/// How much of what its goal allows a figure uses; above 1 it is missed.
double share_of_goal(const Figure& figure) {
  constexpr double kUnknown = 1e3;  // could not be measured
  const Goal& goal = *figure.goal;
  const double value = figure.measured;
  if (!std::isfinite(value)) return kUnknown;
  const double share = goal.least && goal.most
                           ? std::abs(2 * value - *goal.least - *goal.most) / (*goal.most - *goal.least)
                       : goal.most ? value / *goal.most
                                   : *goal.least / value;
  return std::isfinite(share) && share > 0 ? share : figure.verdict() == reports::ReportVerdict::met ? 0 : kUnknown;
}

/// What must hold, what is only shown, and what is missed; then all goals in one picture.
void conclude(reports::Report& report, const FidelityResults& results) {
  constexpr std::size_t kNamed = 8;
  const std::int64_t met = results.count(reports::ReportVerdict::met),
                     missed = results.count(reports::ReportVerdict::missed),
                     shown = results.count(reports::ReportVerdict::shown);
  std::vector<std::string> points;
  std::vector<double> shares;
  for (const Chapter& chapter : results.chapters)
    for (const Figure& f : chapter.figures) {
      if (f.goal) shares.push_back(share_of_goal(f));
      if (f.verdict() != reports::ReportVerdict::missed || points.size() >= kNamed) continue;
      const std::string unit = f.unit == "1" ? "" : " " + f.unit;
      points.push_back("Missed: " + chapter.section.title + ", " + f.name + ": " + output::short_number(f.measured, 3) +
                       unit + " where the goal is " + f.goal->text(f.unit) + ".");
    }
  if (missed > std::int64_t(points.size()))
    points.push_back("And " + std::to_string(missed - std::int64_t(points.size())) + " more, marked below.");
  points.push_back("Must hold: " + std::to_string(met + missed) +
                   " goals. Only shown, without a goal: " + std::to_string(shown) + " figures.");
  report.conclude(missed == 0 ? reports::ReportVerdict::met : reports::ReportVerdict::missed,
                  missed == 0 ? "All " + std::to_string(met) + " goals are met."
                              : std::to_string(missed) + " of " + std::to_string(met + missed) + " goals are missed.",
                  points);
  if (!shares.empty())
    report.add_plots({reports::plot_of_bounds("Of what the goals allow, this much is used", shares)});
}

std::string results_json(const FidelityResults& results) {
  output::JsonWriter json;
  json.begin_object()
      .member("format", "ctpm-fidelity-results")
      .member("version", 1)
      .member("program_version", CTPM_VERSION)
      .member("scene", results.scene.value_or(""))
      .member("is_quick", results.is_quick)
      .member("goals_met", results.count(reports::ReportVerdict::met))
      .member("goals_missed", results.count(reports::ReportVerdict::missed));
  json.key("figures");
  reports::write_rows(json, figures_table(results.chapters));
  json.key("recipes").begin_list();
  for (const Chapter& chapter : results.chapters) {
    const reports::Section& section = chapter.section;
    json.begin_object().member("key", std::string_view(section.key)).member("title", std::string_view(section.title));
    json.key("tables").begin_list();
    for (const reports::Table& table : section.tables) {
      json.begin_object().member("title", std::string_view(table.title)).key("rows");
      reports::write_rows(json, table);
      json.end_object();
    }
    json.end_list().key("plots").begin_list();
    for (const reports::Plot& plot : section.plots) reports::write_points(json, plot);
    json.end_list().end_object();
  }
  return json.end_list().end_object().text();
}

}  // namespace

reports::Table figures_table(const std::vector<Chapter>& chapters) {
  reports::Table table;
  table.columns = {{"recipe", "recipe"},
                   {"figure", "figure"},
                   {"radius_mm", "r [mm]"},
                   {"measured", "measured"},
                   {"unit", "unit"},
                   {"reference", "reference"},
                   {"source", "reference from"},
                   {"error_percent", "error [%]"},
                   {"goal_least", "goal, least"},
                   {"goal_most", "goal, most"},
                   {"verdict", "verdict"},
                   {"note", "note"}};
  const auto optional = [](const std::optional<double>& value) { return value ? cell(*value) : reports::Cell(); };
  for (const Chapter& chapter : chapters)
    for (const Figure& f : chapter.figures)
      table.rows.push_back({f.recipe, f.name, f.radius > 0 ? reports::Cell(1e3 * f.radius) : reports::Cell(),
                            cell(f.measured), f.unit, optional(f.reference), f.source, cell(100 * f.error()),
                            f.goal ? optional(f.goal->least) : reports::Cell(),
                            f.goal ? optional(f.goal->most) : reports::Cell(), f.verdict(), f.note});
  return table;
}

Result<Done> write_fidelity_report(const std::string& folder, const FidelityResults& results) {
  reports::Report report("Fidelity: what a filled organ does against what it should do", subtitle_of(results));
  conclude(report, results);
  report.add_table(overview(results));
  report.add_heading("Goals");
  for (const Chapter& chapter : results.chapters) {
    if (chapter.figures.empty()) continue;
    reports::Table goals = goals_of(chapter);
    goals.title = chapter.section.title;
    report.add_table(goals);
  }
  for (const Chapter& chapter : results.chapters)
    if (const Result<Done> added = report.add(chapter.section); !added) return added;
  return reports::write_report(folder, {{"results.json", results_json(results)},
                                        {"results.csv", reports::to_csv(figures_table(results.chapters))},
                                        {"report.html", report.html()}});
}

}  // namespace ctpm::fidelity
