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

// Error against run time, in time, space, structure and tiling.
namespace ctpm::bench {

struct BenchOptions {
  std::vector<std::string> scenes;  ///< scene files for the study in time; empty: the shipped ones
  std::string shipped;              ///< folder of the shipped scenes
  bool is_quick = false;            ///< coarser fillings and fewer settings, for a first look
  std::function<void(const Errors& warnings)> take_warnings;  ///< receives the warnings of `scenes`
};

/// The result of a study: a section for the page, rows for programs, conclusions as sentences.
struct BenchStudy {
  reports::Section section;
  reports::Table points;
  std::vector<std::string> sentences;
};

using BenchProgress = std::function<void(std::int64_t done, std::int64_t total)>;

/// Integrators, substeps and tolerances against a reference whose own error is estimated by halving the step. One study
/// for each scene and motion.
Result<std::vector<BenchStudy>> run_bench_time(const BenchOptions& options, const BenchProgress& progress);

/// Sphere radii down to a quarter of the shipped one, with one tool and path, against the finest.
Result<BenchStudy> run_bench_space(const BenchOptions& options, const BenchProgress& progress);

/// The four structures on the paper's rig against the closed forms and the paper's Table 1.
Result<BenchStudy> run_bench_structure(const BenchOptions& options, const BenchProgress& progress);

/// The two tilings of the CTPM on a block that a ball enters, against Lee & Radok.
Result<BenchStudy> run_bench_tiling(const BenchOptions& options, const BenchProgress& progress);

/// Writes report.html, results.json and results.csv into a folder.
Result<Done> write_bench_report(const std::string& folder, const std::vector<BenchStudy>& studies);

/// A motion of the hand from rest, for the studies in time and space.
struct BenchMotion {
  std::function<Inputs(std::int64_t tick)> hand;
  std::int64_t ticks = 0;
};

/// Positions, forces and computing time of each tick of a run.
struct BenchRun {
  std::vector<Vec3Array> position;                         ///< [m]               (tick_count)
  std::vector<Vec3> force;                                 ///< on the tool [N]   (tick_count)
  std::vector<double> seconds;                             ///< wall clock [s]    (tick_count)
  std::int64_t unconverged = 0;                            ///< ticks whose solver reached its iteration limit
  stepping::StepStatus status = stepping::StepStatus::ok;  ///< status that ended the run early; `ok`: none did
};
BenchRun run_motion(const Model& model, const BenchMotion& motion);

/// Relative L2 error over the whole trajectory; position_error() compares displacements from rest.
double position_error(const BenchRun& run, const BenchRun& reference, const Vec3Array& rest);
double force_error(const BenchRun& run, const BenchRun& reference);

/// The percentile of `values` at `share` in [0, 1]; 0 if there are none.
double percentile(std::vector<double> values, double share);

/// Indices of the Pareto-optimal points, fastest first: no other point is both faster and more accurate.
std::vector<std::size_t> pareto_front(const std::vector<double>& cost, const std::vector<double>& error);

/// Columns of results.csv, the same for every study; a study leaves cells that it does not have empty.
reports::Table bench_layout();

}  // namespace ctpm::bench
