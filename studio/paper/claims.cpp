#include "studio/paper/claims.h"

#include <algorithm>
#include <cmath>

#include "studio/output/number_text.h"

namespace ctpm::paper {
namespace {

using reports::ReportVerdict;

double share(const std::optional<double>& got, const std::optional<double>& wanted) {
  return got && wanted && *wanted != 0 ? *got / *wanted - 1 : std::nan("");
}

reports::Cell cell(const std::optional<double>& value) { return value ? reports::Cell(*value) : reports::Cell(); }
reports::Cell percent(double value) { return std::isfinite(value) ? reports::Cell(100 * value) : reports::Cell(); }

std::string count_of(const Counts& counts) {
  return std::to_string(counts.met) + " of " + std::to_string(counts.asked());
}

/// "force at 4 mm" for "force at 4 mm [N]".
std::string without_unit(std::string quantity) {
  const std::size_t from = quantity.find(" ["), to = quantity.find(']');
  return from < to && to != std::string::npos ? quantity.erase(from, to + 1 - from) : quantity;
}

/// "liver CTPM force at 4 mm (+38.6 %)".
std::string short_name(const Claim& claim) {
  std::string text = claim.organ;
  for (const std::string& part : {claim.structure, claim.viscosity, without_unit(claim.quantity)})
    if (!part.empty()) text += " " + part;
  const double off = claim.error();
  if (std::isfinite(off)) text += std::string(" (") + (off > 0 ? "+" : "") + output::fixed(100 * off, 1) + " %)";
  return text;
}

/// Claims of one kind about one figure of the paper.
struct FigureCount {
  ClaimKind kind;
  std::string figure;
  Counts counts;
  std::string missed;  ///< names, separated by "; "
};

void add(Counts& counts, ReportVerdict verdict) {
  ++(verdict == ReportVerdict::met ? counts.met : verdict == ReportVerdict::missed ? counts.missed : counts.shown);
}

/// In the order in which the claims name the figures.
std::vector<FigureCount> count_by_figure(const std::vector<Claim>& claims) {
  std::vector<FigureCount> figures;
  for (const ClaimKind kind : {ClaimKind::print, ClaimKind::behaviour})
    for (const Claim& claim : claims) {
      if (claim.kind != kind) continue;
      auto at = std::find_if(figures.begin(), figures.end(),
                             [&](const FigureCount& f) { return f.kind == kind && f.figure == claim.figure; });
      if (at == figures.end()) at = figures.insert(at, {kind, claim.figure, {}, ""});
      add(at->counts, claim.verdict());
      if (claim.verdict() == ReportVerdict::missed) at->missed += (at->missed.empty() ? "" : "; ") + short_name(claim);
    }
  return figures;
}

/// "lambda of Table 1: 18 of 18; measured ranges of Fig. 8: 1 of 2".
std::string by_figure(const std::vector<Claim>& claims, ClaimKind kind) {
  std::string text;
  for (const FigureCount& figure : count_by_figure(claims))
    if (figure.kind == kind && figure.counts.asked() > 0)
      text += (text.empty() ? "" : "; ") + figure.figure + ": " + count_of(figure.counts);
  return text;
}

}  // namespace

const char* name_of(ClaimKind kind) {
  switch (kind) {
    case ClaimKind::network:
      return "network";
    case ClaimKind::convergence:
      return "convergence";
    case ClaimKind::print:
      return "print";
    case ClaimKind::behaviour:
      return "behaviour";
  }
  return "";
}

double Claim::error() const {
  if (own_error) return *own_error;
  if (kind != ClaimKind::print) return share(network, closed_form);
  if (!paper_low || !paper_high || !closed_form) return share(closed_form, paper);
  const double nearest = std::clamp(*closed_form, *paper_low, *paper_high);
  return *closed_form / nearest - 1;
}

ReportVerdict Claim::verdict() const {
  bool is_met = true;
  // A NaN is within no bound.
  if (bound) is_met = std::abs(error()) <= *bound;
  if (holds) is_met = is_met && *holds;
  if (!is_met) return ReportVerdict::missed;
  return bound || holds ? ReportVerdict::met : ReportVerdict::shown;
}

Counts count_claims(const std::vector<Claim>& claims, ClaimKind kind, const std::string& experiment) {
  Counts counts;
  for (const Claim& claim : claims)
    if (claim.kind == kind && (experiment.empty() || claim.experiment == experiment)) add(counts, claim.verdict());
  return counts;
}

bool network_holds(const std::vector<Claim>& claims) {
  return std::none_of(claims.begin(), claims.end(), [](const Claim& claim) {
    return must_hold(claim.kind) && claim.verdict() == ReportVerdict::missed;
  });
}

std::vector<Sentence> headline(const std::vector<Claim>& claims) {
  std::vector<Sentence> sentences;
  for (const ClaimKind kind : kClaimKinds) {
    const Counts counts = count_claims(claims, kind);
    if (counts.asked() == 0) continue;
    const std::string count = count_of(counts);
    switch (kind) {
      case ClaimKind::network:
        sentences.push_back(
            {kind, "The network meets the closed forms in " + count + " comparisons, all of which must hold" +
                       (counts.shown > 0
                            ? "; " + std::to_string(counts.shown) + " more are shown without a bound, and say why."
                            : ".")});
        break;
      case ClaimKind::convergence:
        sentences.push_back({kind, "The network converges in " + count + " cases, all of which must."});
        break;
      case ClaimKind::print:
        sentences.push_back({kind, "The closed forms meet " + count + " values that the paper prints (" +
                                       by_figure(claims, kind) +
                                       "). A miss is the paper's own scatter or a limit of its model, and no failure "
                                       "of the network."});
        break;
      case ClaimKind::behaviour:
        sentences.push_back({kind, "What the paper's figures say about behaviour holds in " + count +
                                       " comparisons on the network (" + by_figure(claims, kind) + ")."});
        break;
    }
  }
  return sentences;
}

reports::Table claims_table(const std::vector<Claim>& claims) {
  reports::Table table;
  table.columns = {{"kind", "what is compared"},
                   {"experiment", "experiment"},
                   {"figure", "figure"},
                   {"organ", "organ"},
                   {"model", "model"},
                   {"viscosity", "viscosity"},
                   {"quantity", "quantity"},
                   {"paper", "paper"},
                   {"paper_low", "paper, from"},
                   {"paper_high", "to"},
                   {"closed_form", "closed form"},
                   {"network", "network"},
                   {"error_percent", "error [%]", 2},
                   {"bound_percent", "bound [%]", 3},
                   {"must_hold", "must hold"},
                   {"verdict", "verdict"},
                   {"note", "note"}};
  for (const Claim& c : claims)
    table.rows.push_back({std::string(name_of(c.kind)), c.experiment, c.figure, c.organ, c.structure, c.viscosity,
                          c.quantity, cell(c.paper), cell(c.paper_low), cell(c.paper_high), cell(c.closed_form),
                          cell(c.network), percent(c.error()), c.bound ? percent(*c.bound) : reports::Cell(),
                          std::string(must_hold(c.kind) ? "yes" : "no"), c.verdict(), c.note});
  return table;
}

reports::Table figures_table(const std::vector<Claim>& claims) {
  reports::Table table;
  table.title = "The paper's printed values and claims, figure by figure";
  table.columns = {{"figure", "figure of the paper"},
                   {"kind", "what is compared"},
                   {"met", "met"},
                   {"missed", "missed"},
                   {"missed_ones", "which are missed"}};
  for (const FigureCount& figure : count_by_figure(claims))
    if (figure.counts.asked() > 0)
      table.rows.push_back({figure.figure,
                            std::string(figure.kind == ClaimKind::print ? "closed form with print"
                                                                        : "network with what the figure says"),
                            figure.counts.met, figure.counts.missed, figure.missed});
  table.caption =
      "A figure of the paper that is not listed prints no value and says nothing that can be counted; its section "
      "shows what the network does.";
  return table;
}

}  // namespace ctpm::paper
