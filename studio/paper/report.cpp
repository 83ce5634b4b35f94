// All experiments of the paper together, and the report about them.

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/model/errors.h"
#include "studio/paper/paper.h"

namespace ctpm::paper {
namespace {

/// Overview: the verdicts on the network, and the counts about the paper, of each experiment.
reports::Table overview(const PaperResults& results) {
  reports::Table table;
  table.title = "Experiment by experiment";
  table.columns = {{"experiment", "experiment"},
                   {"verdict", "network"},
                   {"must_hold", "must hold"},
                   {"missed", "missed"},
                   {"print", "printed values"},
                   {"print_met", "met"},
                   {"behaviour", "claims about behaviour"},
                   {"behaviour_met", "met"}};
  for (const reports::Section& section : results.sections) {
    Counts network;
    for (const ClaimKind kind : {ClaimKind::network, ClaimKind::convergence}) {
      const Counts part = count_claims(results.claims, kind, section.key);
      network.met += part.met, network.missed += part.missed;
    }
    const Counts print = count_claims(results.claims, ClaimKind::print, section.key),
                 behaviour = count_claims(results.claims, ClaimKind::behaviour, section.key);
    std::vector<reports::Cell>& row = table.rows.emplace_back(table.columns.size());
    row[0] = section.title;
    if (network.asked() > 0) row[2] = network.asked(), row[3] = network.missed;
    if (print.asked() > 0) row[4] = print.asked(), row[5] = print.met;
    if (behaviour.asked() > 0) row[6] = behaviour.asked(), row[7] = behaviour.met;
    if (network.asked() > 0)
      table.rows.back()[1] = network.missed > 0 ? reports::ReportVerdict::missed : reports::ReportVerdict::met;
  }
  return table;
}

/// "counts": for each kind of claim, whether it must hold, and how many do.
void write_counts(output::JsonWriter& json, const std::vector<Claim>& claims) {
  json.key("counts").begin_object();
  for (const ClaimKind kind : kClaimKinds) {
    const Counts counts = count_claims(claims, kind);
    json.key(name_of(kind))
        .begin_object()
        .member("must_hold", must_hold(kind))
        .member("met", counts.met)
        .member("missed", counts.missed)
        .member("shown", counts.shown)
        .end_object();
  }
  json.end_object();
}

std::string results_json(const PaperResults& results) {
  output::JsonWriter json;
  json.begin_object()
      .member("format", "ctpm-paper-results")
      .member("version", 2)
      .member("program_version", CTPM_VERSION)
      .member("network_holds", network_holds(results.claims));
  write_counts(json, results.claims);
  json.key("headline").begin_list();
  for (const Sentence& sentence : headline(results.claims)) json.value(std::string_view(sentence.text));
  json.end_list().key("figures");
  reports::write_rows(json, figures_table(results.claims));
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

const char* title_of(ClaimKind kind) {
  switch (kind) {
    case ClaimKind::network:
      return "The network with the closed forms: must hold";
    case ClaimKind::convergence:
      return "The network with finer fillings: must hold";
    case ClaimKind::print:
      return "The closed forms with what the paper prints: counted";
    case ClaimKind::behaviour:
      return "The network with what the paper's figures say: counted";
  }
  return "";
}

/// The claims of one kind and experiment, in the columns that a reader of the page needs; results.csv has them all.
reports::Table claims_of(const std::vector<Claim>& all, ClaimKind kind, const std::string& experiment) {
  std::vector<Claim> own;
  std::copy_if(all.begin(), all.end(), std::back_inserter(own),
               [&](const Claim& c) { return c.kind == kind && c.experiment == experiment; });
  const reports::Table claims = claims_table(own);
  const auto is_needed = [&](std::size_t i) {
    const std::string& key = claims.columns[i].key;
    if (key == "experiment" || key == "kind" || key == "must_hold") return false;
    return std::any_of(claims.rows.begin(), claims.rows.end(), [&](const std::vector<reports::Cell>& row) {
      const auto* text = std::get_if<std::string>(&row[i]);
      return text ? !text->empty() : !std::holds_alternative<std::monostate>(row[i]);
    });
  };
  reports::Table table;
  table.title = title_of(kind);
  table.rows.resize(claims.rows.size());
  for (std::size_t i = 0; i < claims.columns.size(); ++i) {
    if (!is_needed(i)) continue;
    table.columns.push_back(claims.columns[i]);
    for (std::size_t r = 0; r < claims.rows.size(); ++r) table.rows[r].push_back(claims.rows[r][i]);
  }
  return table;
}

/// What must hold, then what is only counted; and all comparisons that have a bound in one picture.
void conclude(reports::Report& report, const std::vector<Claim>& claims) {
  std::vector<std::string> points;
  std::int64_t asked = 0, missed = 0;
  for (const Claim& claim : claims) {
    if (!must_hold(claim.kind) || claim.verdict() == reports::ReportVerdict::shown) continue;
    ++asked;
    if (claim.verdict() != reports::ReportVerdict::missed) continue;
    ++missed;
    points.push_back("Missed: " + claim.organ + (claim.organ.empty() ? "" : ", ") + claim.quantity +
                     (claim.note.empty() ? "" : " (" + claim.note + ")") + ".");
  }
  for (const Sentence& sentence : headline(claims))
    points.push_back((must_hold(sentence.kind) ? "Must hold: " : "Only counted: ") + sentence.text);
  const std::string all = std::to_string(asked);
  report.conclude(missed == 0 ? reports::ReportVerdict::met : reports::ReportVerdict::missed,
                  missed == 0 ? "Everything that must hold does: " + all + " comparisons of the network."
                              : std::to_string(missed) + " of " + all + " comparisons that must hold " +
                                    (missed == 1 ? "is" : "are") + " missed.",
                  points);
  std::vector<double> shares;
  for (const ClaimKind kind : {ClaimKind::network, ClaimKind::print})
    for (const Claim& claim : claims)
      if (claim.kind == kind && claim.bound.value_or(0) > 0 && std::isfinite(claim.error()))
        shares.push_back(std::abs(claim.error()) / *claim.bound);
  if (!shares.empty()) report.add_plots({reports::plot_of_bounds("Network, then print: share of its bound", shares)});
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
  // The experiments take minutes, so the scenes are checked first.
  Errors errors = check_experiments(scenes);
  if (!errors.empty()) return errors;
  for (std::size_t i = 0; i < runners.size(); ++i) {
    progress(std::int64_t(i), std::int64_t(runners.size()));
    Result<Experiment> experiment = runners[i]();
    if (!experiment) {
      append(errors, experiment);
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
                         "on Meshless for Surgical Robot System. Each value of the network comes from a shipped scene "
                         "that it ran; closed forms are only compared with it.");
  conclude(report, results.claims);
  report.add_table(overview(results));
  report.add_table(figures_table(results.claims));
  for (const reports::Section& section : results.sections) {
    if (const Result<Done> added = report.add(section); !added) return added;
    // Table 1 shows its values itself.
    if (section.key == "table-1") continue;
    for (const ClaimKind kind : kClaimKinds)
      if (const reports::Table own = claims_of(results.claims, kind, section.key); !own.rows.empty())
        report.add_table(own);
  }
  return reports::write_report(folder, {{"results.json", results_json(results)},
                                        {"results.csv", reports::to_csv(claims_table(results.claims))},
                                        {"report.html", report.html()}});
}

}  // namespace ctpm::paper
