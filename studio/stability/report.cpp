// The page about the stability cases: which runs met their conditions, which were refused, and plots of the failures.

#include "studio/reports/report.h"
#include "studio/stability/stability.h"

namespace ctpm::stability {
namespace {

/// All runs, one per row, for programs.
reports::Table runs_table(const std::vector<StabilityRow>& rows) {
  reports::Table table;
  table.columns = {{"case", "case"},
                   {"title", "what"},
                   {"integrator", "integrator"},
                   {"used", "used"},
                   {"substeps", "substeps"},
                   {"verdict", "verdict"},
                   {"reason", "reason"},
                   {"ticks", "ticks done"},
                   {"unconverged_ticks", "ticks not converged"},
                   {"fallback_ticks", "ticks by backward Euler instead"},
                   {"reach_mm", "furthest [mm]"},
                   {"end_speed_mm_per_s", "fastest at the end [mm/s]"},
                   {"expectation", "what must hold"}};
  for (const StabilityRow& row : rows)
    for (const StabilityRun& run : row.runs)
      table.rows.push_back({row.what->key, row.what->title, std::string(stepping::name_of(run.asked)),
                            std::string(stepping::name_of(run.used)), std::int64_t(run.substeps), run.verdict,
                            run.reason, run.ticks, run.unconverged, run.fallbacks, 1e3 * run.reach, 1e3 * run.end_speed,
                            row.what->expectation});
  return table;
}

/// One row per case: the verdict under each integrator.
reports::Table overview(const std::vector<StabilityRow>& rows) {
  reports::Table table;
  table.columns = {{"title", "case"}};
  if (!rows.empty())
    for (const StabilityRun& run : rows[0].runs)
      table.columns.push_back({stepping::name_of(run.asked), stepping::name_of(run.asked), 4, !run.asked});
  table.columns.push_back({"used", "auto takes"});
  table.columns.push_back({"reach", "furthest under auto [mm]", 3});
  table.columns.push_back({"expectation", "what must hold"});
  for (const StabilityRow& row : rows) {
    const StabilityRun& automatic = row.runs[0];
    std::string used = stepping::name_of(automatic.used);
    if (automatic.substeps > 1) used += ", " + std::to_string(automatic.substeps) + " substeps";
    std::vector<reports::Cell> cells;
    cells.emplace_back(row.what->title);
    for (const StabilityRun& run : row.runs) cells.emplace_back(run.verdict);
    cells.emplace_back(used), cells.emplace_back(1e3 * automatic.reach), cells.emplace_back(row.what->expectation);
    table.rows.push_back(cells);
  }
  table.caption =
      "met: all holds. refused: the integrator that was named said before or at the first bad tick "
      "that it cannot, and left the State as it was. missed: it ran, and something does not hold, see below.";
  return table;
}

/// Why runs were refused, one line for each reason and integrator.
reports::Table refusals(const std::vector<StabilityRow>& rows) {
  reports::Table table;
  table.title = "Refused, and why";
  table.columns = {{"title", "case"}, {"integrator", "integrator"}, {"ticks", "after ticks"}, {"reason", "reason"}};
  for (const StabilityRow& row : rows)
    for (const StabilityRun& run : row.runs)
      if (run.verdict == reports::ReportVerdict::refused)
        table.rows.push_back({row.what->title, std::string(stepping::name_of(run.asked)), run.ticks, run.reason});
  return table;
}

std::vector<reports::Plot> plots_of(const StabilityRun& run) {
  reports::Plot distance{.title = "furthest sphere", .x_title = "time [s]", .y_title = "distance from rest [mm]"};
  reports::Plot energy{
      .title = "energy of motion, springs and gravity", .x_title = "time [s]", .y_title = "energy [J]"};
  distance.series.push_back(run.distance), energy.series.push_back(run.energy);
  distance.height = energy.height = 260;
  return {distance, energy};
}

/// The runs that missed, those of `auto` first.
std::vector<reports::Section> failures(const std::vector<StabilityRow>& rows) {
  std::vector<reports::Section> sections;
  for (const bool is_automatic : {true, false})
    for (const StabilityRow& row : rows)
      for (const StabilityRun& run : row.runs) {
        if (run.verdict != reports::ReportVerdict::missed || run.asked.has_value() == is_automatic) continue;
        reports::Section section;
        section.key = row.what->key + "/" + stepping::name_of(run.asked);
        section.title = std::string("Missed under ") + stepping::name_of(run.asked) + ": " + row.what->title;
        section.paragraphs = {"Must hold: " + row.what->expectation + ".", "Does not: " + run.reason + "."};
        section.plots = plots_of(run);
        sections.push_back(section);
      }
  return sections;
}

/// What must hold, which is that auto holds every case; what integrators that were named did is shown.
void conclude(reports::Report& report, const std::vector<StabilityRow>& rows) {
  const std::int64_t failed = count_failures(rows);
  std::int64_t met = 0, refused = 0, missed = 0;
  std::string names;
  for (const StabilityRow& row : rows) {
    if (row.runs[0].verdict == reports::ReportVerdict::missed) names += (names.empty() ? "" : "; ") + row.what->title;
    for (std::size_t i = 1; i < row.runs.size(); ++i) {
      const reports::ReportVerdict verdict = row.runs[i].verdict;
      met += verdict == reports::ReportVerdict::met, missed += verdict == reports::ReportVerdict::missed;
      refused += verdict == reports::ReportVerdict::refused;
    }
  }
  std::vector<std::string> points;
  if (!names.empty()) points.push_back("Missed under auto: " + names + ".");
  points.push_back("Must hold: every case under the integrator that auto takes.");
  if (met + refused + missed > 0)
    points.push_back("Only shown: integrators that are named. Of their runs " + std::to_string(met) + " hold, " +
                     std::to_string(refused) + " are refused with the reason, " + std::to_string(missed) +
                     " do not hold" + (missed > 0 ? " and are drawn below." : "."));
  const std::string count = std::to_string(rows.size());
  const std::string all = rows.size() == 1 ? "the one case" : "all " + count + " cases";
  report.conclude(
      failed == 0 ? reports::ReportVerdict::met : reports::ReportVerdict::missed,
      failed == 0 ? "auto holds " + all + "." : "auto fails " + std::to_string(failed) + " of " + count + " cases.",
      points);
  std::vector<double> shares;
  for (const StabilityRow& row : rows) shares.push_back(row.runs[0].reach / row.what->reach);
  report.add_plots({reports::plot_of_bounds("Under auto, of the way that spheres may go, this much is gone", shares)});
}

std::string results_json(const std::vector<StabilityRow>& rows, const std::vector<reports::Section>& failed) {
  output::JsonWriter json;
  json.begin_object()
      .member("format", "ctpm-stability-results")
      .member("version", 1)
      .member("program_version", CTPM_VERSION)
      .member("cases", rows.size())
      .member("failures_under_auto", count_failures(rows));
  json.key("runs");
  reports::write_rows(json, runs_table(rows));
  json.key("missed").begin_list();
  for (const reports::Section& section : failed) {
    json.begin_object().member("key", std::string_view(section.key)).key("plots").begin_list();
    for (const reports::Plot& plot : section.plots) reports::write_points(json, plot);
    json.end_list().end_object();
  }
  return json.end_list().end_object().text();
}

}  // namespace

Result<Done> write_stability_report(const std::string& folder, const std::vector<StabilityRow>& rows) {
  reports::Report report("Stability on stiff and extreme cases",
                         "Each case is a small scene of liver tissue (r = 4 mm, the paper's moduli, viscosity in kPa "
                         "s, ticks of "
                         "1 ms where nothing else is said) that is driven to an extreme, run under every integrator.");
  conclude(report, rows);
  report.add_table(overview(rows));
  report.add_heading("How it is judged");
  report.add_paragraph(
      "Of every sampled tick it is asked that all numbers are finite and no sphere is further from its "
      "rest position than the case allows. Energy is that of motion, of springs and two-sphere TPMs, "
      "and of gravity; it may not grow from the tick on from which nothing does work on the tissue.");
  report.add_paragraph(
      "Where a network has neither constraint nor softening that is asked from sample to sample. The "
      "constraint "
      "(Eq. 2) has no energy function, so with it energy may not pass what it was when the tissue was let "
      "go. Softening "
      "(Eq. 8) makes springs give back less than they seem to hold, so with it the energy of motion and "
      "gravity alone "
      "may not pass what all energy was then. Leapfrog keeps an energy that differs from the true one by up to "
      "the square of its share s of the longest stable step, so there the bound is 1 / (1 - s^2) times that, and the "
      "mean "
      "of the second half may not pass that of the first. All bounds have a slack of 1e-4 of what is stored and in "
      "motion, as solves stop at a residual. SDIRK2 says beforehand that it has no numerical damping: where energy "
      "grows or "
      "rest does not come, that is a failure of SDIRK2 as of any other.");
  const std::vector<reports::Section> sections = failures(rows);
  for (const reports::Section& section : sections)
    if (const Result<Done> added = report.add(section); !added) return added;
  const reports::Table refused = refusals(rows);
  if (!refused.rows.empty()) report.add_heading("Refusals"), report.add_table(refused);
  return reports::write_report(folder, {{"results.json", results_json(rows, sections)},
                                        {"results.csv", reports::to_csv(runs_table(rows))},
                                        {"report.html", report.html()}});
}

}  // namespace ctpm::stability
