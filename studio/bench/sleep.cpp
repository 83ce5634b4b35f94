// What sleeping organs save while another one is pressed, and what leaving them out changes.

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/elements/parts.h"
#include "core/model/errors.h"
#include "core/model/nearest_rank.h"
#include "core/stepping/sleepers.h"
#include "studio/bench/bench.h"
#include "studio/bench/motions.h"
#include "studio/loading/standing.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

/// Bounds that are compared, beside the scene's own [m/s].
constexpr double kBounds[] = {1e-6, 1e-5, 1e-4, 1e-3};

constexpr int kRounds = 3;  ///< runs of which the least times count

/// A scene as it stands, and a press of its first organ.
struct SleepJob {
  std::string name;
  Model model;
  BenchMotion motion;
  std::int64_t wait = 0;  ///< ticks before the press, in which what is at rest falls asleep
};

/// What one bound does.
struct Slept {
  double bound = 0;           ///< [m/s]; 0: all are awake
  double share = 0;           ///< of the spheres that slept, mean over the ticks of the press
  double p50 = 0, p99 = 0;    ///< of a tick of the press [s]
  double run_time = 0;        ///< of the press [s per simulated s]
  double force_error = 0;     ///< relative L2
  double position_error = 0;  ///< relative L2
  double farthest = 0;        ///< largest distance of a sphere from where it is with all awake [m]
};

Model with_bound(Model model, double bound) {
  model.solver.sleep_bound = bound;
  return model;
}

/// Solved so well that only what sleeps makes a difference.
Model exact(Model model) {
  model.solver.tolerance = 1e-9, model.solver.velocity_floor = 1e-13, model.solver.velocity_enough = 0,
  model.solver.max_iterations = 5000;
  return model;
}

/// Empty if the scene is one part, of which nothing stands still while it is pressed.
Result<std::optional<SleepJob>> make_job(const std::string& path) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(path);
  if (!scene) return scene.errors();
  const Model& model = scene->built.model;
  const std::int32_t ball = first_tool(model, ToolKind::ball);
  if (ball < 0 || elements::parts_of(model).size() < 2) return std::optional<SleepJob>();
  SleepJob job{scene->scene.spec.name, model, {}, stepping::Sleepers::ticks_before_sleep(model) + 20};
  std::optional<loading::Standing> standing = loading::settle_scene(scene->scene.spec, model);
  const BenchMotion press = press_the_top(model, ball, standing->state);
  job.motion.ticks = job.wait + press.ticks, job.motion.start = std::move(standing->state);
  job.motion.hand = [press, wait = job.wait](std::int64_t tick) {
    return tick < wait ? Inputs{} : press.hand(tick - wait);
  };
  return std::optional(std::move(job));
}

double farthest_apart(const BenchRun& run, const BenchRun& reference) {
  double farthest = 0;
  for (std::size_t t = 0; t < std::min(run.position.size(), reference.position.size()); ++t)
    for (std::size_t i = 0; i < run.position[t].size(); ++i)
      farthest = std::max(farthest, norm(run.position[t][i] - reference.position[t][i]));
  return farthest;
}

/// Least time of each tick of the press over some runs [s], which other programs disturb least. The bounds take turns.
std::vector<std::vector<double>> least_times(const SleepJob& job, const std::vector<double>& bounds,
                                             const std::function<void()>& advance) {
  std::vector<std::vector<double>> least(bounds.size());
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t b = 0; b < bounds.size(); ++b) {
      const BenchRun run = run_motion(with_bound(job.model, bounds[b]), job.motion);
      const auto ticks = std::min(run.seconds.size(), std::size_t(job.motion.ticks));
      least[b].resize(ticks - std::min(ticks, std::size_t(job.wait)), INFINITY);
      for (std::size_t t = 0; t < least[b].size(); ++t)
        least[b][t] = std::min(least[b][t], run.seconds[t + std::size_t(job.wait)]);
      advance();
    }
  return least;
}

/// Errors: a run that was refused.
Result<Slept> measure(const SleepJob& job, double bound, const std::vector<double>& seconds,
                      const BenchRun& reference) {
  const BenchRun solved = run_motion(exact(with_bound(job.model, bound)), job.motion);
  if (solved.status != stepping::StepStatus::ok || std::int64_t(seconds.size()) + job.wait != job.motion.ticks)
    return Error{job.name, "the press of its first organ was refused", "ask `ctpm plan` whether its integrator holds"};
  Slept slept{bound};
  slept.run_time = run_time_of(seconds, job.model.tick);
  slept.p50 = percentile(seconds, 0.5), slept.p99 = percentile(seconds, 0.99);
  for (auto asleep = solved.asleep.begin() + job.wait; asleep != solved.asleep.end(); ++asleep) slept.share += *asleep;
  slept.share /= double(seconds.size()) * double(job.model.sphere_count());
  slept.force_error = force_error(solved, reference);
  slept.position_error = position_error(solved, reference, job.motion.start->position);
  slept.farthest = farthest_apart(solved, reference);
  return slept;
}

std::string in_mm_per_s(double bound) { return output::short_number(1e3 * bound, 3) + " mm/s"; }

reports::Table table_of(const std::vector<Slept>& all) {
  reports::Table table;
  table.title = "What sleeps, what a tick costs, and what that changes";
  table.columns = {{"sleep_below_mm_per_s", "sleep_below_mm_per_s", 3},
                   {"asleep", "share of spheres that sleep", 3},
                   {"tick_p50_ms", "tick p50 [ms]", 3},
                   {"tick_p99_ms", "p99 [ms]", 3},
                   {"force_error", "error in force", 3},
                   {"position_error", "error in position", 3},
                   {"farthest_mm", "farthest sphere [mm]", 3}};
  for (const Slept& s : all)
    table.rows.push_back({s.bound > 0 ? reports::Cell(1e3 * s.bound) : reports::Cell(std::string("all awake")), s.share,
                          1e3 * s.p50, 1e3 * s.p99, s.force_error, s.position_error, 1e3 * s.farthest});
  return table;
}

reports::Plot plot_of(const std::vector<Slept>& all) {
  reports::Plot plot{.title = "force", .x_title = "tick p50 [ms]", .y_title = "relative L2 error in force"};
  plot.is_log_x = plot.is_log_y = true;
  for (const Slept& s : all)
    if (s.force_error > 0)
      plot.series.push_back({.name = in_mm_per_s(s.bound),
                             .x = {1e3 * s.p50},
                             .y = {s.force_error},
                             .stroke = reports::Stroke::marks,
                             .colour = int(plot.series.size()) % 6});
  return plot;
}

/// A bound is recommended only if it changes the force by less than this share, and no place by more than that [m].
constexpr double kMostForceError = 1e-3, kFarthest = 5e-5;

/// What the bound does under which most sleeps without changing much; of several alike, the one that changes least.
std::string sentence_of(const SleepJob& job, const std::vector<Slept>& all) {
  const Slept& awake = all.front();
  const auto worth = [](const Slept& s) {
    const bool is_close = s.force_error <= kMostForceError && s.farthest <= kFarthest;
    return std::pair(is_close ? std::floor(100 * s.share) : 0.0, -s.force_error);
  };
  const auto best =
      std::max_element(all.begin() + 1, all.end(), [&](const Slept& a, const Slept& b) { return worth(a) < worth(b); });
  if (worth(*best).first < 1)
    return job.name +
           ": hardly anything can sleep while its first organ is pressed without changing that, at bounds "
           "of up to " +
           in_mm_per_s(all.back().bound) + ".";
  return job.name + ": with sleep_below_mm_per_s " + output::short_number(1e3 * best->bound, 3) + ", " +
         percent(best->share) + " of the spheres sleep while its first organ is pressed; a tick takes " +
         output::short_number(1e3 * best->p50, 3) + " ms instead of " + output::short_number(1e3 * awake.p50, 3) +
         " (p50), the force differs by " + percent(best->force_error) + " and no sphere by more than " +
         output::short_number(1e3 * best->farthest, 2) + " mm.";
}

Result<BenchStudy> study_of(const SleepJob& job, const std::function<void()>& advance) {
  std::vector<double> bounds(std::begin(kBounds), std::end(kBounds));
  if (job.model.solver.sleep_bound > 0) bounds.push_back(job.model.solver.sleep_bound);
  std::sort(bounds.begin(), bounds.end());
  bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
  bounds.insert(bounds.begin(), 0.0);
  const BenchRun reference = run_motion(exact(with_bound(job.model, 0)), job.motion);
  advance();
  const std::vector<std::vector<double>> seconds = least_times(job, bounds, advance);
  std::vector<Slept> all;
  for (std::size_t b = 0; b < bounds.size(); ++b) {
    const Result<Slept> slept = measure(job, bounds[b], seconds[b], reference);
    if (!slept) return slept.errors();
    all.push_back(*slept);
    advance();
  }
  BenchStudy study;
  study.section.key = "sleep", study.section.title = "Sleep: " + job.name;
  study.section.paragraphs = {
      std::to_string(job.model.sphere_count()) + " spheres in " + std::to_string(elements::parts_of(job.model).size()) +
          " parts that can sleep. The scene has stood still for " +
          output::short_number(double(job.wait) * job.model.tick, 2) +
          " s when its first ball presses its first organ. Times are those of the scene's own solver, the least of "
          "three runs for each tick; errors are those "
          "of leaving parts out alone: differences, in L2 over the whole trajectory, from the same run with all awake, "
          "both solved to a residual of 1e-9.",
      sentence_of(job, all)};
  study.section.plots = {plot_of(all)}, study.section.tables = {table_of(all)};
  study.sentences = {study.section.paragraphs.back()};
  study.points = bench_layout();
  for (const Slept& s : all) {
    std::vector<reports::Cell> row(study.points.columns.size());
    const auto set = [&](const char* key, reports::Cell cell) {
      const auto column = std::find_if(study.points.columns.begin(), study.points.columns.end(),
                                       [&](const reports::Column& c) { return c.key == key; });
      row[std::size_t(column - study.points.columns.begin())] = std::move(cell);
    };
    set("study", std::string("sleep")), set("scene", job.name);
    set("spheres", std::int64_t(job.model.sphere_count()));
    set("sleep_below_mm_per_s", 1e3 * s.bound), set("asleep", s.share);
    set("position_error", s.position_error), set("force_error", s.force_error);
    set("run_time_s_per_s", s.run_time), set("tick_p50_ms", 1e3 * s.p50), set("tick_p99_ms", 1e3 * s.p99);
    study.points.rows.push_back(std::move(row));
  }
  return study;
}

}  // namespace

Result<std::vector<BenchStudy>> run_bench_sleep(const BenchOptions& options, const BenchProgress& progress) {
  const std::vector<std::string> scenes =
      options.scenes.empty() ? std::vector{options.shipped + "/two-organs.json"} : options.scenes;
  std::vector<BenchStudy> studies;
  // The reference, and for each bound the timed runs and an exact one.
  const auto of_scene = std::int64_t(1 + (kRounds + 1) * (std::size(kBounds) + 1));
  const std::int64_t total = std::int64_t(scenes.size()) * of_scene;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    std::int64_t done = std::int64_t(i) * of_scene;
    const Result<std::optional<SleepJob>> job = make_job(scenes[i]);
    if (!job) return job.errors();
    if (!*job) continue;
    Result<BenchStudy> study = study_of(**job, [&] { progress(std::min(++done, total), total); });
    if (!study) return study.errors();
    studies.push_back(*std::move(study));
  }
  return studies;
}

}  // namespace ctpm::bench
