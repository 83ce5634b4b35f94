#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "studio/reports/table.h"

namespace ctpm::paper {

/// What a claim compares. The first two are about the network and must hold; the others are about the paper and are
/// counted.
enum class ClaimKind {
  network,      ///< the network with a closed form
  convergence,  ///< the network with itself, more finely filled
  print,        ///< a closed form with a number or a range that the paper prints
  behaviour,    ///< the network with what a figure of the paper says about behaviour
};
inline constexpr std::array kClaimKinds{ClaimKind::network, ClaimKind::convergence, ClaimKind::print,
                                        ClaimKind::behaviour};

/// "network", "convergence", "print", "behaviour".
const char* name_of(ClaimKind kind);
/// Whether a missed claim of this kind is a failure of the network.
constexpr bool must_hold(ClaimKind kind) { return kind == ClaimKind::network || kind == ClaimKind::convergence; }

/// One comparison: a quantity, its values, and what is asked of them.
struct Claim {
  ClaimKind kind = ClaimKind::network;
  std::string experiment;   ///< key of its section: "table-1", "relaxation", ...
  std::string figure = {};  ///< of the paper, by which `print` and `behaviour` are counted
  std::string organ;
  std::string structure = {};  ///< "CTPM", "TPM", "mass-spring"
  std::string viscosity = {};  ///< unit of the viscosity: "kPa s", "Pa s"; empty: irrelevant
  std::string quantity = {};   ///< with its unit: "force at 4 mm [N]"
  std::optional<double> paper = {}, closed_form = {}, network = {};
  std::optional<double> paper_low = {}, paper_high = {};  ///< a printed range; both or none
  std::optional<double> own_error = {};                   ///< [share]; unset: computed from the values
  std::optional<double> bound = {};                       ///< largest error [share]; unset: none
  std::optional<bool> holds = {};                         ///< whether a condition holds; unset: no condition
  std::string note = {};

  /// [share]: of the network to the closed form; for `print`, of the closed form to the printed number, or to the
  /// nearest end of the printed range if it lies outside. NaN if a value is unknown.
  double error() const;
  /// Missed if the error exceeds its bound or the condition does not hold; shown without bound and condition.
  reports::ReportVerdict verdict() const;
};

/// Number of claims by verdict.
struct Counts {
  std::int64_t met = 0, missed = 0, shown = 0;
  std::int64_t asked() const { return met + missed; }
};
/// Counts the claims of one kind, and of one experiment if `experiment` is not empty.
Counts count_claims(const std::vector<Claim>& claims, ClaimKind kind, const std::string& experiment = {});

/// Whether every claim that must hold does.
bool network_holds(const std::vector<Claim>& claims);

/// What the claims come to, one sentence for each kind that occurs.
struct Sentence {
  ClaimKind kind;
  std::string text;
};
std::vector<Sentence> headline(const std::vector<Claim>& claims);

/// All claims as one table, for the page, results.json and results.csv.
reports::Table claims_table(const std::vector<Claim>& claims);

/// The claims of `print` and `behaviour` counted by figure of the paper; names those that are missed.
reports::Table figures_table(const std::vector<Claim>& claims);

}  // namespace ctpm::paper
