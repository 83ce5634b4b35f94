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

// Stiff and extreme cases, run under every integrator, and their verdicts.
namespace ctpm::stability {

/// One case: a small scene, its disturbance or inputs, and the conditions that must hold.
struct StabilityCase {
  std::string key;          ///< name in files, for example "stiffness-1e6"
  std::string title;        ///< name for people
  std::string expectation;  ///< the conditions in words; finite and bounded are always required
  std::function<Model()> build;
  std::function<void(const Model& model, State& state)> disturb =
      {};  ///< changes the initial State, which is at rest; empty: no change
  std::function<Inputs(std::int64_t tick)> hand = {};        ///< empty: no tool
  std::function<bool(std::int64_t tick)> is_bad_input = {};  ///< ticks whose input must be refused
  std::int64_t ticks = 0;

  double reach = 0;             ///< no sphere may get further from its rest position [m]
  std::int64_t free_from = -1;  ///< from this tick on nothing does work on the tissue; -1: never
  double end_speed = kAny;      ///< no sphere may be faster at the end [m/s]
  double end_distance = kAny;   ///< no sphere may be further from its rest position at the end [m]
  /// A further condition on the first and the last State. Returns the violation, or an empty text.
  std::function<std::string(const Model& model, const State& first, const State& last)> also = {};

  static constexpr double kAny = std::numeric_limits<double>::infinity();
};

/// All cases. With `is_quick` the long ones (an hour at rest, 4,096 spheres, the shortest ticks) are reduced, and 1e5
/// spheres are left out.
std::vector<StabilityCase> stability_cases(bool is_quick);

/// The result of a case under one integrator.
struct StabilityRun {
  std::optional<Integrator> asked;  ///< none: the Model's own choice
  Integrator used = Integrator::backward_euler;
  std::int32_t substeps = 1;
  reports::ReportVerdict verdict = reports::ReportVerdict::missed;  ///< met, missed or refused
  std::string reason;                                               ///< why it was missed or refused; empty if met
  std::int64_t ticks = 0;                                           ///< simulated
  std::int64_t unconverged = 0;                                     ///< ticks whose solver reached its iteration limit
  std::int64_t fallbacks = 0;        ///< ticks in which backward Euler took a step for sdirk2
  double reach = 0;                  ///< largest distance of a sphere from its rest position [m]
  double end_speed = 0;              ///< fastest sphere at the end [m/s]
  reports::Series distance, energy;  ///< over time [s]: largest distance [mm], total energy [J]
};

/// Runs one case. Every sampled State must be finite and bounded, and a refused tick must leave the State unchanged.
/// Under the Model's own choice of integrator only bad input may be refused.
///
/// The energy is the sum of kinetic, spring, two-sphere TPM and gravitational energy. From `free_from` on it may not
/// grow:
/// - implicit integrators, networks without constraint and softening: not from one sample to the next;
/// - with a constraint (Eq. 2), which has no energy function: never above its value at `free_from`;
/// - with softening (Eq. 8), where springs return less than their energy function says: kinetic plus gravitational
///   energy never above the total at `free_from`;
/// - leapfrog conserves an energy that differs from this one by up to s^2, where s is its step over the longest stable
///   step: above the value at `free_from` by at most 1 / (1 - s^2) - 1 of the largest kinetic plus elastic energy; and
///   the mean of the second half above that of the first by at most 5 % of the same energy.
/// Every bound has a slack of 1e-4 of that energy, because solvers stop at a residual.
///
/// Refused is only what a named integrator said before the first tick or in the first bad one, which it left undone.
/// What ran and then failed is missed, also where the integrator had announced that it has no numerical damping.
StabilityRun run_stability_case(const StabilityCase& what, std::optional<Integrator> integrator);

/// The results of one case, in the order of kStabilityIntegrators; of the first ones alone if only those were run.
struct StabilityRow {
  const StabilityCase* what;
  std::vector<StabilityRun> runs;
};

inline constexpr std::optional<Integrator> kStabilityIntegrators[] = {std::nullopt, Integrator::leapfrog,
                                                                      Integrator::backward_euler, Integrator::sdirk2};

/// Runs all cases, several at a time, under the first `integrators` of kStabilityIntegrators, at least 1. `progress` is
/// called from one thread at a time.
std::vector<StabilityRow> run_stability(const std::vector<StabilityCase>& cases, std::size_t integrators,
                                        const std::function<void(std::int64_t done, std::int64_t total)>& progress);

/// Number of runs under the Model's own choice of integrator that missed.
std::int64_t count_failures(const std::vector<StabilityRow>& rows);

/// Writes report.html, results.json and results.csv into a folder.
Result<Done> write_stability_report(const std::string& folder, const std::vector<StabilityRow>& rows);

}  // namespace ctpm::stability
