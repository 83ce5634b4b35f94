// Error against run time for integrators, substeps and tolerances.

#include <algorithm>
#include <cmath>
#include <future>
#include <tuple>
#include <utility>

#include "core/model/errors.h"
#include "core/model/nearest_rank.h"
#include "core/stepping/step.h"
#include "studio/bench/bench.h"
#include "studio/bench/motions.h"
#include "studio/loading/standing.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

/// Sphere radius of the shipped organs but for the first study, which has their own [m]: references take as long as
/// tens of the finest runs.
constexpr double kRadius = 6e-3, kQuickRadius = 9e-3;

constexpr double kReferenceTolerance = 1e-9;

/// Explicit settings that need more substeps are left out, because they are slower than the reference.
constexpr double kMostSubsteps = 1000;

/// Number of ticks for the percentiles of the recommended setting.
constexpr std::size_t kTimedTicks = 1000;

/// A reference whose own error is more than this says nothing.
constexpr double kMostGap = 0.05;

struct TimeJob {
  std::string title;
  std::string organ;  ///< whose own filling it has; empty if another
  Model model;
  BenchMotion motion;
  bool is_pressed;  ///< from above, by a ball
};

struct Setting {
  Integrator integrator;
  std::int32_t substeps;
  double tolerance;
};

struct Point {
  Setting setting;
  double position_error = 0, force_error = 0;
  double run_time = 0;                ///< [s per simulated s]
  bool feels = false;                 ///< the tool felt a force
  double p50 = 0, p99 = 0, p999 = 0;  ///< of a tick [s]
  std::int64_t unconverged = 0, fallbacks = 0;
  bool is_on_front = false;
};

std::string name_of_setting(const Setting& s) {
  std::string name = std::string(stepping::name_of(s.integrator)) + ", " + std::to_string(s.substeps) +
                     (s.substeps == 1 ? " substep" : " substeps");
  if (s.integrator != Integrator::leapfrog) name += ", tolerance " + output::short_number(s.tolerance);
  return name;
}

Model with_setting(Model model, const Setting& setting) {
  model.solver.integrator = setting.integrator;
  model.solver.substeps = setting.substeps;
  model.solver.tolerance = setting.tolerance;
  model.solver.velocity_floor = std::min(model.solver.velocity_floor, 1e-2 * setting.tolerance);
  model.solver.velocity_enough = std::min(model.solver.velocity_enough, 1e-1 * setting.tolerance);
  model.solver.max_iterations = 2000;
  return model;
}

/// A motion, and the kind of tool that a scene must have for it.
struct Deed {
  ToolKind kind;
  std::function<BenchMotion(const Model&, std::int32_t tool, const State& start)> motion;
};

/// Without gravity. Every run starts from the State in which the organs have come to rest under their own tension. The
/// title is the scene's name and `what` is done.
Result<TimeJob> make_job(const std::string& path, const std::string& what, const Deed& deed,
                         const std::function<void(scenes::SceneSpec&)>& change, const BenchOptions& options = {}) {
  const auto prepare = [&](scenes::SceneSpec& spec) {
    spec.gravity = {}, spec.loads.clear();
    change(spec);
  };
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(path, {}, prepare);
  if (!scene) return scene.errors();
  if (options.take_warnings) options.take_warnings(scene->scene.warnings);
  TimeJob job{scene->scene.spec.name + ", " + what, "", scene->built.model, {}, deed.kind == ToolKind::ball};
  const std::int32_t tool = first_tool(job.model, deed.kind);
  if (tool < 0)
    return Error{path, std::string("has no ") + (deed.kind == ToolKind::scalpel ? "scalpel" : "ball"),
                 "add one to its tools"};
  std::optional<loading::Standing> standing = loading::settle_scene(scene->scene.spec, job.model);
  job.motion = deed.motion(job.model, tool, standing->state);
  job.motion.start = std::move(standing->state);
  return job;
}

Result<std::vector<TimeJob>> make_jobs(const BenchOptions& options) {
  std::vector<Result<TimeJob>> made;
  const auto coarse = [&](scenes::SceneSpec& spec) {
    for (scenes::OrganSpec& organ : spec.organs)
      organ.fill.radius = organ.fill.gap = options.is_quick ? kQuickRadius : kRadius;
  };
  const Deed press{ToolKind::ball, press_the_top}, press_both{ToolKind::ball, press_between},
      cut{ToolKind::scalpel, cut_along_x};
  const auto shipped = [&](const char* name) { return options.shipped + "/" + name + ".json"; };
  const std::string liver = shipped("liver"), what = "press and release";
  for (const std::string& path : scenes_of(options)) {
    made.push_back(make_job(
        path, what, press, [](scenes::SceneSpec&) {}, options));
    if (made.back()) made.back()->organ = made.back()->model.organs[0].name;
  }
  if (options.scenes.empty()) {
    if (!options.is_quick) {
      made.push_back(make_job(liver, what + ", viscosity in Pa s", press, [&](scenes::SceneSpec& spec) {
        coarse(spec), spec.organs[0].material.preset += "-pa-s";
      }));
      made.push_back(make_job(liver, what + ", stiffness x 100", press, [&](scenes::SceneSpec& spec) {
        scenes::MaterialSpec& m = spec.organs[0].material;
        coarse(spec), m.stiffness_scale = 100 * m.stiffness_scale.value_or(1);
      }));
      made.push_back(make_job(shipped("two-organs"), "pressed together", press_both, coarse));
      made.push_back(make_job(shipped("kidney"), "cut along its length", cut, coarse));
    }
  }
  std::vector<TimeJob> jobs;
  Errors errors;
  for (Result<TimeJob>& job : made) {
    if (job)
      jobs.push_back(std::move(*job));
    else
      append(errors, job);
  }
  if (!errors.empty()) return errors;
  return jobs;
}

std::vector<Setting> settings_for(const Model& model, bool is_quick) {
  std::vector<Setting> settings;
  const double needed = std::max(1.0, std::ceil(model.tick / (0.9 * stepping::stable_step_bound(model))));
  for (double n = needed; n <= std::min(kMostSubsteps, 4 * needed); n *= 2)
    settings.push_back({Integrator::leapfrog, std::int32_t(n), 1e-4});
  const std::vector<double> tolerances = is_quick ? std::vector{1e-2, 1e-5} : std::vector{1e-1, 1e-2, 1e-4, 1e-6};
  for (const double tolerance : tolerances) {
    for (std::int32_t n = 1; n <= (is_quick ? 4 : 8); n *= 2)
      settings.push_back({Integrator::backward_euler, n, tolerance});
    for (std::int32_t n = 1; n <= (is_quick ? 2 : 4); n *= 2) settings.push_back({Integrator::sdirk2, n, tolerance});
  }
  return settings;
}

Point measure(const TimeJob& job, const Setting& setting, const BenchRun& run, const BenchRun& reference) {
  Point point{setting};
  point.position_error = position_error(run, reference, job.motion.start->position, job.model.mass);
  point.force_error = force_error(run, reference);
  point.feels = feels(run);
  point.run_time = run_time_of(run.seconds, job.model.tick);
  point.p50 = percentile(run.seconds, 0.5), point.p99 = percentile(run.seconds, 0.99),
  point.p999 = percentile(run.seconds, 0.999);
  point.unconverged = run.unconverged, point.fallbacks = run.fallbacks;
  return point;
}

/// Settings that nothing beats in both. Those under which the tool feels nothing are none.
std::vector<std::size_t> front_of(const std::vector<Point>& points, double Point::*error) {
  std::vector<double> cost, errors;
  for (const Point& p : points) cost.push_back(p.run_time), errors.push_back(p.feels ? p.*error : INFINITY);
  return pareto_front(cost, errors);
}

/// One line for each integrator and tolerance, along its substeps, and the front if there is one.
reports::Plot diagram(const std::string& title, const std::vector<Point>& points, double Point::*error,
                      const char* what, bool has_front) {
  reports::Plot plot{.title = title, .x_title = "processor time [s per simulated s]", .y_title = what};
  plot.is_log_x = plot.is_log_y = true;
  for (const Point& p : points) {
    std::string name = stepping::name_of(p.setting.integrator);
    if (p.setting.integrator != Integrator::leapfrog) name += " " + output::short_number(p.setting.tolerance);
    auto it =
        std::find_if(plot.series.begin(), plot.series.end(), [&](const reports::Series& s) { return s.name == name; });
    if (it == plot.series.end()) {
      reports::Series series{.name = name};
      series.stroke = p.setting.integrator == Integrator::sdirk2 ? reports::Stroke::dashed : reports::Stroke::line;
      series.colour = p.setting.integrator == Integrator::leapfrog ? 6 : int(-std::log10(p.setting.tolerance)) % 6;
      it = plot.series.insert(plot.series.end(), series);
    }
    it->x.push_back(p.run_time), it->y.push_back(p.*error);
  }
  reports::Series front{.name = "Pareto front", .stroke = reports::Stroke::marks, .colour = 1};
  for (const std::size_t i : front_of(points, error))
    front.x.push_back(points[i].run_time), front.y.push_back(points[i].*error);
  if (has_front) plot.series.push_back(front);
  return plot;
}

/// The settings of one integrator at its tightest tolerance, coarsest steps first.
std::vector<const Point*> tightest_of(const std::vector<Point>& points, Integrator integrator) {
  double tightest = 1;
  for (const Point& p : points)
    if (p.setting.integrator == integrator) tightest = std::min(tightest, p.setting.tolerance);
  std::vector<const Point*> own;
  for (const Point& p : points)
    if (p.setting.integrator == integrator && p.setting.tolerance == tightest) own.push_back(&p);
  return own;
}

constexpr Integrator kIntegrators[] = {Integrator::leapfrog, Integrator::backward_euler, Integrator::sdirk2};

/// How far a reference is off the run with half as many substeps.
struct Gap {
  double position = 0, force = 0;
};

/// Why the steps of a case do not converge; empty if they do.
std::string why_not_converged(const std::vector<Point>& points, Gap gap) {
  for (const auto& [name, error, own] :
       {std::tuple{"force", &Point::force_error, gap.force}, {"position", &Point::position_error, gap.position}}) {
    for (const Integrator integrator : kIntegrators) {
      const std::vector<const Point*> steps = tightest_of(points, integrator);
      std::vector<double> errors;
      for (const Point* p : steps) errors.push_back(p->*error);
      const auto at = [&](std::size_t i) {
        return percent(errors[i]) + " at " + std::to_string(steps[i]->setting.substeps) +
               (steps[i]->setting.substeps == 1 ? " substep" : " substeps");
      };
      if (const std::optional<std::size_t> i = first_growth(errors, own))
        return std::string("the error of ") + stepping::name_of(integrator) + " in " + name + " grows from " +
               at(*i - 1) + " to " + at(*i);
    }
    if (own > kMostGap)
      return std::string("the reference itself changes by ") + percent(own) + " in " + name +
             " when its steps are halved";
  }
  return "";
}

/// Errors at the tightest tolerance, and the order between each row and the one above it. Errors that the reference,
/// whose own is up to `gap`, does not tell apart have none.
reports::Table orders(const std::vector<Point>& points, Gap gap) {
  reports::Table table;
  table.title = "Errors at the tightest tolerance, and their orders in the step from the row above";
  table.columns = {{"integrator", "integrator"},        {"substeps", "substeps"},      {"position", "in position", 3},
                   {"position_order", "order", 3},      {"force", "in force", 3},      {"force_order", "order", 3},
                   {"tick_p50_ms", "tick p50 [ms]", 3}, {"tick_p99_ms", "p99 [ms]", 3}};
  for (const Integrator integrator : kIntegrators) {
    const Point* before = nullptr;
    for (const Point* p : tightest_of(points, integrator)) {
      const auto order = [&](double Point::*error, double own) -> reports::Cell {
        if (!before || p->*error <= 2 * own) return {};
        return std::log(before->*error / p->*error) / std::log(double(p->setting.substeps) / before->setting.substeps);
      };
      table.rows.push_back({std::string(stepping::name_of(integrator)), std::int64_t(p->setting.substeps),
                            p->position_error, order(&Point::position_error, gap.position), p->force_error,
                            order(&Point::force_error, gap.force), 1e3 * p->p50, 1e3 * p->p99});
      before = p;
    }
  }
  return table;
}

/// Order of SDIRK2 in position where a pin moves what the ball presses, between 2 and 4 substeps.
double order_without_contact(const TimeJob& job, std::int32_t fine) {
  Model model = job.model;
  BenchMotion motion = move_the_top(model, *job.motion.start);
  motion.start = job.motion.start;
  const auto run = [&](std::int32_t substeps) {
    const Setting setting{Integrator::sdirk2, substeps, kReferenceTolerance};
    return run_motion(with_setting(model, setting), motion);
  };
  const BenchRun reference = run(fine);
  const auto error = [&](std::int32_t substeps) {
    return position_error(run(substeps), reference, motion.start->position, model.mass);
  };
  return std::log2(error(2) / error(4));
}

/// Names the most accurate setting whose tick takes at most the scene's tick at p99, with percentiles over many ticks;
/// none if the case does not converge, for the reason `why`.
std::string recommendation(const TimeJob& job, std::vector<Point> points, const std::string& why) {
  if (!why.empty()) return job.title + ": does not converge: " + why + ". Nothing is recommended.";
  const double tick = job.model.tick;
  const std::string rate =
      output::short_number(1e-3 / tick) + " kHz with " + std::to_string(job.model.sphere_count()) + " spheres";
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.position_error < b.position_error; });
  for (const Point& p : points) {
    if (p.p99 > tick || !p.feels) continue;
    const Model model = with_setting(job.model, p.setting);
    std::vector<double> seconds;
    while (seconds.size() < kTimedTicks) {
      const BenchRun run = run_motion(model, job.motion);
      seconds.insert(seconds.end(), run.seconds.begin(), run.seconds.end());
    }
    const double p99 = percentile(seconds, 0.99);
    if (p99 > tick) continue;
    return job.title + ": the most accurate setting that holds " + rate + " on this machine is " +
           name_of_setting(p.setting) + ": error " + percent(p.position_error) + " in position and " +
           percent(p.force_error) + " in force; ticks of " + output::short_number(1e3 * percentile(seconds, 0.5), 3) +
           " ms (p50), " + output::short_number(1e3 * p99, 3) + " ms (p99), " +
           output::short_number(1e3 * percentile(seconds, 0.999), 3) + " ms (p99.9).";
  }
  return job.title + ": no setting holds " + rate + " at p99 on this machine.";
}

/// What the settings of a scene's own filling cost, each integrator at its loosest tolerance that is no looser than the
/// scene's own.
void add_costs(const TimeJob& job, const std::vector<Point>& points, BenchStudy& study) {
  const SolverSettings& solver = job.model.solver;
  for (const Integrator integrator : kIntegrators) {
    double tolerance = 0;
    for (const Point& p : points)
      if (p.setting.integrator == integrator &&
          (integrator == Integrator::leapfrog || p.setting.tolerance <= solver.tolerance))
        tolerance = std::max(tolerance, p.setting.tolerance);
    for (const Point& p : points) {
      const Setting& s = p.setting;
      const bool is_own = integrator == solver.integrator && s.substeps == solver.substeps;
      if (p.feels && s.integrator == integrator && s.tolerance == tolerance)
        study.costs.push_back({job.organ, std::string("time, ") + stepping::name_of(integrator), name_of_setting(s),
                               1e3 * p.p50, p.force_error, is_own});
    }
  }
}

/// What the study's section says before its numbers.
std::vector<std::string> words_of(const TimeJob& job, std::int32_t fine, Gap gap) {
  return {std::to_string(job.model.sphere_count()) +
              " spheres of r = " + output::short_number(1e3 * job.model.organs[0].sphere_radius, 3) + " mm, " +
              std::to_string(job.motion.ticks) + " ticks of " + output::short_number(1e3 * job.model.tick) +
              " ms, no gravity, from where the organs have come to rest. Errors are relative differences in L2 over "
              "the whole trajectory, of displacements and of "
              "the force on the tool, from a reference: sdirk2 with " +
              std::to_string(fine) + " substeps and tolerance " + output::short_number(kReferenceTolerance) +
              ", two refinements finer than the finest implicit setting. It differs from the run with half as many "
              "substeps by " +
              percent(gap.position) + " in position and " + percent(gap.force) +
              " in force: an estimate of its own error, not a bound. Errors below that are not told apart.",
          "Numbers in the legend are tolerances; along a line the substeps double."};
}

std::vector<reports::Cell> row_of(const TimeJob& job, const Point& p) {
  return {std::string("time"),
          job.title,
          reports::Cell(),
          std::string(stepping::name_of(p.setting.integrator)),
          std::int64_t(p.setting.substeps),
          p.setting.tolerance,
          1e3 * job.model.organs[0].sphere_radius,
          reports::Cell(),
          std::int64_t(job.model.sphere_count()),
          p.position_error,
          p.force_error,
          p.run_time,
          1e3 * p.p50,
          1e3 * p.p99,
          1e3 * p.p999,
          p.unconverged,
          p.fallbacks,
          p.is_on_front ? reports::Cell(std::string("front")) : reports::Cell()};
}

/// The reference and its distance from the run with half its substeps; both run in parallel, timed runs run alone.
std::pair<BenchRun, Gap> make_reference(const TimeJob& job, std::int32_t fine) {
  const auto run = [&](std::int32_t substeps) {
    return run_motion(with_setting(job.model, {Integrator::sdirk2, substeps, kReferenceTolerance}), job.motion);
  };
  std::future<BenchRun> other = std::async(std::launch::async, [&] { return run(fine / 2); });
  BenchRun reference = run(fine);
  const BenchRun halved = other.get();
  const Gap gap{position_error(halved, reference, job.motion.start->position, job.model.mass),
                force_error(halved, reference)};
  return {std::move(reference), gap};
}

BenchStudy study(const TimeJob& job, const BenchOptions& options, const std::function<void()>& advance) {
  const std::int32_t fine = options.is_quick ? 16 : 32;
  const auto [reference, gap] = make_reference(job, fine);
  advance();
  std::vector<Point> points;
  for (const Setting& setting : settings_for(job.model, options.is_quick)) {
    const BenchRun run = run_motion(with_setting(job.model, setting), job.motion);
    if (run.status == stepping::StepStatus::ok) points.push_back(measure(job, setting, run, reference));
  }
  const std::string why = !feels(reference) ? "the tool feels nothing" : why_not_converged(points, gap);
  if (why.empty())
    for (const std::size_t i : front_of(points, &Point::position_error)) points[i].is_on_front = true;
  BenchStudy study;
  study.section.key = "time", study.section.title = "Time: " + job.title;
  study.section.plots = {
      diagram("position", points, &Point::position_error, "relative L2 error in position", why.empty()),
      diagram("force", points, &Point::force_error, "relative L2 error in force", why.empty())};
  study.section.paragraphs = words_of(job, fine, gap);
  study.sentences = {recommendation(job, points, why)};
  study.section.paragraphs.push_back(study.sentences[0]);
  study.section.tables = {orders(points, gap)};
  if (job.is_pressed)
    study.section.paragraphs.push_back(
        "Where a pin moves the pressed sphere along the ball's way, without contact, the order of sdirk2 in position "
        "is " +
        output::short_number(order_without_contact(job, fine), 3) +
        " between 2 and 4 substeps: where that is 2 and the table has less, contacts that begin and end within steps "
        "cost the difference, since the force has a kink there.");
  if (!job.organ.empty() && why.empty()) add_costs(job, points, study);
  if (!job.organ.empty() && !why.empty()) study.left_out.push_back({job.organ, "time", why});
  study.points = bench_layout();
  for (const Point& p : points) study.points.rows.push_back(row_of(job, p));
  return study;
}

}  // namespace

Result<std::vector<BenchStudy>> run_bench_time(const BenchOptions& options, const BenchProgress& progress) {
  const Result<std::vector<TimeJob>> jobs = make_jobs(options);
  if (!jobs) return jobs.errors();
  std::vector<BenchStudy> studies;
  std::int64_t done = 0;
  const auto advance = [&] { progress(++done, 2 * std::int64_t(jobs->size())); };
  for (const TimeJob& job : *jobs) studies.push_back(study(job, options, advance)), advance();
  return studies;
}

}  // namespace ctpm::bench
