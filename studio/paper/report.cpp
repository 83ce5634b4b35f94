// All experiments of the paper together, and the report about them.

#include <algorithm>
#include <iterator>

#include "studio/paper/paper.h"

namespace ctpm::paper {
namespace {

/// Overview: the number of claims of each experiment that hold.
reports::Table overview(const PaperResults& results) {
  reports::Table table;
  table.columns = {{"experiment", "experiment"}, {"must_hold", "must hold"},     {"met", "met"},
                   {"missed", "missed"},         {"shown", "shown as they are"}, {"verdict", "verdict"}};
  for (const reports::Section& section : results.sections) {
    std::int64_t counts[3] = {0, 0, 0};
    for (const Claim& claim : results.claims)
      if (claim.experiment == section.key) ++counts[int(claim.verdict())];
    const std::int64_t met = counts[int(reports::ReportVerdict::met)],
                       missed = counts[int(reports::ReportVerdict::missed)];
    const reports::ReportVerdict verdict = missed > 0 ? reports::ReportVerdict::missed
                                           : met > 0  ? reports::ReportVerdict::met
                                                      : reports::ReportVerdict::shown;
    table.rows.push_back(
        {section.title, met + missed, met, missed, counts[int(reports::ReportVerdict::shown)], verdict});
  }
  return table;
}

std::string results_json(const PaperResults& results) {
  output::JsonWriter json;
  json.begin_object()
      .member("format", "ctpm-paper-results")
      .member("version", 1)
      .member("program_version", CTPM_VERSION);
  json.key("claims");
  reports::write_rows(json, claims_table(results.claims));
  json.key("experiments").begin_list();
  for (const reports::Section& section : results.sections) {
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

/// Columns of the claims that a reader of the page needs; results.csv has them all.
reports::Table shortened(const reports::Table& claims) {
  const auto is_needed = [&](std::size_t i) {
    if (claims.columns[i].key == "experiment") return false;
    return std::any_of(claims.rows.begin(), claims.rows.end(), [&](const std::vector<reports::Cell>& row) {
      const auto* text = std::get_if<std::string>(&row[i]);
      return text ? !text->empty() : !std::holds_alternative<std::monostate>(row[i]);
    });
  };
  reports::Table table;
  table.rows.resize(claims.rows.size());
  for (std::size_t i = 0; i < claims.columns.size(); ++i) {
    if (!is_needed(i)) continue;
    table.columns.push_back(claims.columns[i]);
    for (std::size_t r = 0; r < claims.rows.size(); ++r) table.rows[r].push_back(claims.rows[r][i]);
  }
  return table;
}

}  // namespace

Result<PaperResults> run_paper_experiments(const std::string& scenes,
                                           const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  using Runner = std::function<Result<Experiment>()>;
  // In the order of the paper.
  const std::vector<Runner> runners{[&] { return run_table_1(scenes); },   [&] { return run_relaxation(scenes); },
                                    [&] { return run_creep(scenes); },     [&] { return run_load(scenes, true); },
                                    [&] { return run_cut(scenes, true); }, [&] { return run_convergence(scenes); }};
  PaperResults results;
  // The experiments take a minute, so the scenes are checked first.
  Errors errors = check_experiments(scenes);
  if (!errors.empty()) return errors;
  for (std::size_t i = 0; i < runners.size(); ++i) {
    progress(std::int64_t(i), std::int64_t(runners.size()));
    Result<Experiment> experiment = runners[i]();
    if (!experiment) {
      errors.insert(errors.end(), experiment.errors().begin(), experiment.errors().end());
      continue;
    }
    results.sections.push_back(std::move(experiment->section));
    results.claims.insert(results.claims.end(), experiment->claims.begin(), experiment->claims.end());
  }
  if (!errors.empty()) return errors;
  return results;
}

Result<Done> write_paper_report(const std::string& folder, const PaperResults& results) {
  reports::Report report("The paper's experiments on the sphere network",
                         "Y. Bao and D. Wu, Establishment and Stability Analysis of a Hybrid Viscoelastic Model Based "
                         "on Meshless for Surgical Robot System. "
                         "Each figure below comes from a shipped scene that the network ran; closed forms are only "
                         "compared with it.");
  const auto missed = std::count_if(results.claims.begin(), results.claims.end(),
                                    [](const Claim& c) { return c.verdict() == reports::ReportVerdict::missed; });
  const auto met = std::count_if(results.claims.begin(), results.claims.end(),
                                 [](const Claim& c) { return c.verdict() == reports::ReportVerdict::met; });
  report.add_verdict(missed == 0, missed == 0 ? "All " + std::to_string(met) + " figures that must hold do."
                                              : std::to_string(missed) + " of " + std::to_string(met + missed) +
                                                    " figures that must hold do not.");
  report.add_table(overview(results));
  for (const reports::Section& section : results.sections) {
    if (const Result<Done> added = report.add(section); !added) return added;
    std::vector<Claim> own;
    std::copy_if(results.claims.begin(), results.claims.end(), std::back_inserter(own),
                 [&](const Claim& c) { return c.experiment == section.key; });
    // Table 1 shows its figures itself.
    if (section.key != "table-1" && !own.empty()) report.add_table(shortened(claims_table(own)));
  }
  return reports::write_report(folder, {{"results.json", results_json(results)},
                                        {"results.csv", reports::to_csv(claims_table(results.claims))},
                                        {"report.html", report.html()}});
}

}  // namespace ctpm::paper
