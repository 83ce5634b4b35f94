#pragma once

#include <cstdint>
#include <functional>
#include <optional>
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
  std::vector<std::string> scenes;  ///< scene files for the studies of one organ; empty: the shipped ones
  std::string shipped;              ///< folder of the shipped scenes
  bool is_quick = false;            ///< coarser fillings and fewer settings, for a first look
  std::function<void(const Errors& warnings)> take_warnings;  ///< receives the warnings of `scenes`
};

/// What one choice costs, and how far it alone takes the force from the truth.
struct CostPoint {
  std::string organ;
  std::string kind;  ///< of error: "time", "space", "structure", "lattice phase"
  std::string name;  ///< of the choice
  double tick_ms = 0;
  double force_error = 0;  ///< share
  bool is_own = false;     ///< the scene's own choice
};

/// A kind of error of an organ that no diagram can show, since the study of it does not converge.
struct LeftOut {
  std::string organ, kind, why;
};

/// The result of a study: a section for the page, rows for programs, conclusions as sentences.
struct BenchStudy {
  reports::Section section;
  reports::Table points;
  std::vector<std::string> sentences;
  std::vector<CostPoint> costs = {};   ///< of choices about one organ, for the diagram that compares the studies
  std::vector<LeftOut> left_out = {};  ///< of that diagram
};

/// The first of `errors`, coarsest refinement first, that is more than a fifth greater than the one before and more
/// than twice `gap`, which a reference does not tell apart: such a case does not converge. None if there is none.
std::optional<std::size_t> first_growth(const std::vector<double>& errors, double gap = 0);

/// The scenes of the studies of one organ: those that are named, else the shipped liver.
std::vector<std::string> scenes_of(const BenchOptions& options);

using BenchProgress = std::function<void(std::int64_t done, std::int64_t total)>;

/// Integrators, substeps and tolerances against a reference whose own error is estimated by halving the step. One study
/// for each scene and motion.
Result<std::vector<BenchStudy>> run_bench_time(const BenchOptions& options, const BenchProgress& progress);

/// Sphere radii about the scene's own, with one tool and path, against a filling two refinements finer than the finest.
/// Scenes whose first organ is a rig, or that have no ball, have no such study.
Result<std::vector<BenchStudy>> run_bench_space(const BenchOptions& options, const BenchProgress& progress);

/// The structures of the same organs, and the scatter of the force as the lattice is turned under them.
Result<std::vector<BenchStudy>> run_bench_organ(const BenchOptions& options, const BenchProgress& progress);

/// What a scene's parts that stand still cost asleep and awake while its first organ is pressed, and the error of
/// leaving them out. Scenes of one part, or without a ball, have no such study.
Result<std::vector<BenchStudy>> run_bench_sleep(const BenchOptions& options, const BenchProgress& progress);

/// The errors of time, space, structure and lattice phase of each organ in one diagram, force in percent against
/// milliseconds a tick, and which of them are left out. Empty without CostPoints.
std::vector<BenchStudy> compare_costs(const std::vector<BenchStudy>& studies);

/// The four structures on the paper's rig against the closed forms and the paper's Table 1.
Result<BenchStudy> run_bench_structure(const BenchOptions& options, const BenchProgress& progress);

/// The two tilings of the CTPM on a block that a ball enters, against Lee & Radok.
Result<BenchStudy> run_bench_tiling(const BenchOptions& options, const BenchProgress& progress);

/// Writes report.html, results.json and results.csv into a folder.
Result<Done> write_bench_report(const std::string& folder, const std::vector<BenchStudy>& studies);

/// A motion of the hand, for the studies in time and space.
struct BenchMotion {
  std::function<Inputs(std::int64_t tick)> hand;
  std::int64_t ticks = 0;
  std::optional<State> start = {};  ///< where it begins; none: with all spheres at their rest positions
};

/// Positions, forces and computing time of each tick of a run.
struct BenchRun {
  std::vector<Vec3Array> position;   ///< [m]               (tick_count)
  std::vector<Vec3> force;           ///< on the tool [N]   (tick_count)
  std::vector<double> seconds;       ///< processor time of the thread, whatever else the machine does [s]  (tick_count)
  std::vector<std::int32_t> asleep;  ///< spheres that slept  (tick_count)
  std::int64_t unconverged = 0;      ///< ticks whose solver reached its iteration limit
  std::int64_t fallbacks = 0;        ///< ticks in which backward Euler took a step for sdirk2
  stepping::StepStatus status = stepping::StepStatus::ok;  ///< status that ended the run early; `ok`: none did
};
BenchRun run_motion(const Model& model, const BenchMotion& motion);

/// Relative L2 error over the whole trajectory; position_error() compares displacements from `start`, each as much as
/// its weight counts; empty: all alike.
double position_error(const BenchRun& run, const BenchRun& reference, const Vec3Array& start,
                      const std::vector<double>& weight = {});
double force_error(const BenchRun& run, const BenchRun& reference);

/// Processor time [s per simulated s] of ticks of `tick` [s] that took `seconds`.
double run_time_of(const std::vector<double>& seconds, double tick);

/// A share for people.
std::string percent(double share);

/// Whether the tool felt any force.
bool feels(const BenchRun& run);

/// Indices of the Pareto-optimal points, fastest first: no other point is both faster and more accurate. A point whose
/// error is infinite is never one.
std::vector<std::size_t> pareto_front(const std::vector<double>& cost, const std::vector<double>& error);

/// Columns of results.csv, the same for every study; a study leaves cells that it does not have empty.
reports::Table bench_layout();

}  // namespace ctpm::bench
