#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/model/inputs.h"
#include "core/model/result.h"
#include "core/model/state.h"
#include "core/stepping/integrator.h"
#include "studio/reports/plot.h"
#include "studio/reports/table.h"

// Stiff and extreme cases that every integrator is put through, and what becomes of each.
namespace ctpm::stability {

/// One case: a small scene, what is done to it, and what must hold then.
struct StabilityCase {
  std::string key;          ///< in files: "stiffness-1e6"
  std::string title;        ///< what it is
  std::string expectation;  ///< what must hold, in words; finite and bounded always must
  std::function<Model()> build;
  std::function<void(const Model& model, State& state)> disturb = {};  ///< the start, from rest; empty: rest
  std::function<Inputs(std::int64_t tick)> hand = {};                  ///< empty: no tool
  std::function<bool(std::int64_t tick)> is_bad_input = {};            ///< ticks whose input must be refused
  std::int64_t ticks = 0;

  double reach = 0;             ///< no sphere may get further from its rest position [m]
  std::int64_t free_from = -1;  ///< first tick from which nothing does work on the tissue; -1: none
  double end_speed = kAny;      ///< no sphere may be faster at the end [m/s]
  double end_distance = kAny;   ///< no sphere may be further from its rest position at the end [m]
  /// What else must hold of the first and the last State: empty if it does, else what is wrong.
  std::function<std::string(const Model& model, const State& first, const State& last)> also = {};

  static constexpr double kAny = std::numeric_limits<double>::infinity();
};

/// All cases. The long ones (an hour at rest, 1e5 spheres, the shortest ticks) are cut down if `is_quick`,
/// and say so in their titles.
std::vector<StabilityCase> stability_cases(bool is_quick);

/// What became of a case under one integrator.
struct StabilityRun {
  std::optional<Integrator> asked;  ///< none: the Model's own choice
  Integrator used = Integrator::backward_euler;
  std::int32_t substeps = 1;
  reports::ReportVerdict verdict = reports::ReportVerdict::missed;  ///< met, missed or refused
  std::string reason;                                               ///< why it was missed or refused; empty if met
  std::int64_t ticks = 0;                                           ///< done
  std::int64_t unconverged = 0;                                     ///< ticks whose solve stopped at its count
  double reach = 0;                  ///< furthest that a sphere was from its rest position [m]
  double end_speed = 0;              ///< fastest sphere at the end [m/s]
  reports::Series distance, energy;  ///< over time [s]: of the furthest sphere [mm], of all [J]
};

/// Runs one case. Finite and bounded are asked of every sampled tick; a tick that is refused must leave the
/// State as it was. No integrator asked: nothing but bad input may be refused.
///
/// Energy is that of motion, springs, two-sphere TPMs and gravity. It may not grow from `free_from` on:
/// - implicit integrators, networks without constraint and softening: from no sample to the next;
/// - with a constraint (Eq. 2), which has no energy function: never above what it was at `free_from`;
/// - with softening (Eq. 8), where springs would seem to hold more than they give back: that of motion and
///   gravity alone never above what all was at `free_from`;
/// - leapfrog keeps an energy that differs from this one by up to the square of its share s of the longest stable
///   step: never above 1 / (1 - s^2) of what it was, and no higher on average in the second half.
///
/// An integrator whose choice says beforehand that it damps nothing (IntegratorChoice::damps) counts as refused where
/// energy grows or rest does not come.
StabilityRun run_stability_case(const StabilityCase& what, std::optional<Integrator> integrator);

/// What all integrators made of one case, in the order of kStabilityIntegrators.
struct StabilityRow {
  const StabilityCase* what;
  std::vector<StabilityRun> runs;
};

inline constexpr std::optional<Integrator> kStabilityIntegrators[] = {std::nullopt, Integrator::leapfrog,
                                                                      Integrator::backward_euler, Integrator::sdirk2};

/// Runs all cases under all integrators, several at a time. `progress` is called from one thread at a time.
std::vector<StabilityRow> run_stability(const std::vector<StabilityCase>& cases,
                                        const std::function<void(std::int64_t done, std::int64_t total)>& progress);

/// Runs under the Model's own choice that did not hold.
std::int64_t count_failures(const std::vector<StabilityRow>& rows);

/// Writes report.html, results.json and results.csv into a folder.
Result<Done> write_stability_report(const std::string& folder, const std::vector<StabilityRow>& rows);

}  // namespace ctpm::stability
