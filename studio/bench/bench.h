#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "core/model/state.h"
#include "core/stepping/integrator.h"
#include "core/stepping/step.h"
#include "studio/loading/loaded_scene.h"
#include "studio/reports/report.h"

// Error against run time, in time, space and structure.
namespace ctpm::bench {

struct BenchOptions {
  std::vector<std::string> scenes;  ///< scene files for the study in time; empty: the shipped ones
  std::string shipped;              ///< folder of the shipped scenes
  bool is_quick = false;            ///< coarser fillings, fewer settings: for a first look
  std::function<void(const Errors& warnings)> take_warnings;  ///< gets those of `scenes`
};

/// What a study found: a section for the page, rows for programs, sentences that say what follows.
struct BenchStudy {
  reports::Section section;
  reports::Table points;
  std::vector<std::string> sentences;
};

using BenchProgress = std::function<void(std::int64_t done, std::int64_t total)>;

/// Integrators, substeps and tolerances, against a reference whose own error is estimated by halving. A
/// section for each scene and motion.
Result<std::vector<BenchStudy>> run_bench_time(const BenchOptions& options, const BenchProgress& progress);

/// Sphere radius at one tool and path, down to a quarter of the shipped one, against the finest.
Result<BenchStudy> run_bench_space(const BenchOptions& options, const BenchProgress& progress);

/// The four structures on the paper's rig, against the closed forms and the paper's Table 1.
Result<BenchStudy> run_bench_structure(const BenchOptions& options, const BenchProgress& progress);

/// Writes report.html, results.json and results.csv into a folder.
Result<Done> write_bench_report(const std::string& folder, const std::vector<BenchStudy>& studies);

/// What both studies of networks do to an organ: a motion of the hand from rest.
struct BenchMotion {
  std::function<Inputs(std::int64_t tick)> hand;
  std::int64_t ticks = 0;
};

/// Positions and forces of a run, tick by tick, and how long each tick took.
struct BenchRun {
  std::vector<Vec3Array> position;                         ///< [m]               (tick_count)
  std::vector<Vec3> force;                                 ///< on the tool [N]   (tick_count)
  std::vector<double> seconds;                             ///< wall clock [s]    (tick_count)
  std::int64_t unconverged = 0;                            ///< ticks whose solve stopped at its count
  stepping::StepStatus status = stepping::StepStatus::ok;  ///< that ended the run; `ok` if none did
};
BenchRun run_motion(const Model& model, const BenchMotion& motion);

/// Relative difference in L2 over the whole trajectory. Positions: of the displacements from rest.
double position_error(const BenchRun& run, const BenchRun& reference, const Vec3Array& rest);
double force_error(const BenchRun& run, const BenchRun& reference);

/// The value that a share of `values` is not above; 0 for none.
double percentile(std::vector<double> values, double share);

/// Indices of the points of which no other is both faster and more accurate, fastest first.
std::vector<std::size_t> pareto_front(const std::vector<double>& cost, const std::vector<double>& error);

/// Columns of results.csv, the same for every study; cells that a study does not have are empty.
reports::Table bench_layout();

}  // namespace ctpm::bench
