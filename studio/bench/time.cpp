// Error against run time for integrators, substeps and tolerances.

#include <algorithm>
#include <cmath>
#include <future>

#include "core/stepping/step.h"
#include "studio/bench/bench.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

/// Sphere radius of the shipped organs in this study [m]: the reference takes as long as tens of the finest runs.
constexpr double kRadius = 6e-3, kQuickRadius = 9e-3;

constexpr double kReferenceTolerance = 1e-9;

/// Explicit settings that need more substeps are left out, because they are slower than the reference.
constexpr double kMostSubsteps = 1000;

/// Number of ticks for the percentiles of the recommended setting.
constexpr std::size_t kTimedTicks = 1000;

struct TimeJob {
  std::string title;
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
  double p50 = 0, p99 = 0, p999 = 0;  ///< of a tick [s]
  std::int64_t unconverged = 0;
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
  model.solver.max_iterations = 2000;
  return model;
}

/// The highest sphere that is free to move.
std::size_t top_of(const Model& model) {
  std::size_t top = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.held_axes[i] == 0 && (model.held_axes[top] != 0 || model.rest_position.z[i] > model.rest_position.z[top]))
      top = i;
  return top;
}

/// The tool goes down by `depth` [m] from `start` at 100 mm/s, stays, and leaves.
BenchMotion press_and_release(const Model& model, std::int32_t tool, Vec3 start, double depth) {
  constexpr double kSpeed = 0.1;
  const double in = depth / kSpeed, hold = 0.02, tick = model.tick;
  BenchMotion motion;
  motion.ticks = std::llround((2 * in + 1.5 * hold) / tick);
  motion.hand = [=](std::int64_t t) {
    const double time = double(t + 1) * tick;
    const double gone = time < in ? kSpeed * time : std::min(depth, depth - kSpeed * (time - in - hold));
    Inputs inputs;
    inputs.tool = tool, inputs.position = start - Vec3{0, 0, gone};
    return inputs;
  };
  return motion;
}

/// The scene's first ball presses the highest free sphere 6 mm deep.
BenchMotion press_the_top(const Model& model, std::int32_t ball) {
  const std::size_t top = top_of(model);
  const double reach = model.tools[std::size_t(ball)].radius + model.contact_radius[top];
  return press_and_release(model, ball, model.rest_position[top] + Vec3{0, 0, reach}, 6e-3);
}

/// A pin, added to `model`, moves the highest free sphere as the ball would, without contact.
BenchMotion move_the_top(Model& model) {
  const std::size_t top = top_of(model);
  model.tools.push_back({"pin", ToolKind::pin, 0, 0, std::int32_t(top)});
  return press_and_release(model, std::int32_t(model.tools.size()) - 1, model.rest_position[top], 6e-3);
}

/// The ball goes between the shipped liver and the kidney behind it, and presses both.
BenchMotion press_between(const Model& model, std::int32_t ball) {
  return press_and_release(model, ball, {-0.045, 0.086, 0.075}, 21e-3);
}

/// The scene's first scalpel goes along x through the middle of the organ's upper half, at 400 mm/s.
BenchMotion cut_along_x(const Model& model, std::int32_t scalpel) {
  constexpr double kSpeed = 0.4;
  const Vec3Array& p = model.rest_position;
  const auto [left, right] = std::minmax_element(p.x.begin(), p.x.end());
  const auto [low, high] = std::minmax_element(p.z.begin(), p.z.end());
  const double spacing = model.organs[0].spacing;
  // Between two layers of spheres, where no sphere's centre is.
  const Vec3 from{*left - spacing, p.y[p.size() / 2] + 0.5 * spacing, *low + 0.55 * (*high - *low)};
  const double way = *right - *left + 2 * spacing, tick = model.tick;
  BenchMotion motion;
  motion.ticks = std::llround(way / kSpeed / tick) + 20;
  motion.hand = [=](std::int64_t t) {
    Inputs inputs;
    const double gone = kSpeed * double(t) * tick;
    if (gone > way) return inputs;
    inputs.tool = scalpel, inputs.position = from + Vec3{gone, 0, 0};
    return inputs;
  };
  return motion;
}

std::int32_t first_tool(const Model& model, ToolKind kind) {
  const auto it = std::find_if(model.tools.begin(), model.tools.end(), [&](const Tool& t) { return t.kind == kind; });
  return it == model.tools.end() ? -1 : std::int32_t(it - model.tools.begin());
}

/// A motion, and the kind of tool that a scene must have for it.
struct Deed {
  ToolKind kind;
  std::function<BenchMotion(const Model&, std::int32_t tool)> motion;
};

/// Without gravity, so that every run starts from the same State.
Result<TimeJob> make_job(const std::string& path, const std::string& title, const Deed& deed,
                         const std::function<void(scenes::SceneSpec&)>& change, const BenchOptions& options = {}) {
  const auto prepare = [&](scenes::SceneSpec& spec) {
    spec.gravity = {}, spec.loads.clear();
    change(spec);
  };
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(path, {}, prepare);
  if (!scene) return scene.errors();
  if (options.take_warnings) options.take_warnings(scene->scene.warnings);
  TimeJob job{title, scene->built.model, {}, deed.kind == ToolKind::ball};
  const std::int32_t tool = first_tool(job.model, deed.kind);
  if (tool < 0)
    return Error{path, std::string("has no ") + (deed.kind == ToolKind::scalpel ? "scalpel" : "ball"),
                 "add one to its tools"};
  job.motion = deed.motion(job.model, tool);
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
  const std::string liver = shipped("liver"), title = "liver, press and release";
  for (const std::string& path : options.scenes)
    made.push_back(make_job(
        path, path + ", press and release", press, [](scenes::SceneSpec&) {}, options));
  if (options.scenes.empty()) {
    made.push_back(make_job(liver, title + ", viscosity in kPa s", press, coarse));
    if (!options.is_quick) {
      made.push_back(make_job(liver, title + ", viscosity in Pa s", press, [&](scenes::SceneSpec& spec) {
        coarse(spec), spec.organs[0].material.preset += "-pa-s";
      }));
      made.push_back(make_job(liver, title + ", stiffness x 100", press, [&](scenes::SceneSpec& spec) {
        scenes::MaterialSpec& m = spec.organs[0].material;
        coarse(spec), m.stiffness_scale = 100 * m.stiffness_scale.value_or(1);
      }));
      made.push_back(make_job(shipped("two-organs"), "liver and kidney, pressed together", press_both, coarse));
      made.push_back(make_job(shipped("kidney"), "kidney, cut along its length", cut, coarse));
    }
  }
  std::vector<TimeJob> jobs;
  Errors errors;
  for (Result<TimeJob>& job : made) {
    if (job)
      jobs.push_back(std::move(*job));
    else
      errors.insert(errors.end(), job.errors().begin(), job.errors().end());
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
    for (std::int32_t n = 1; n <= (is_quick ? 4 : 16); n *= 2)
      settings.push_back({Integrator::backward_euler, n, tolerance});
    for (std::int32_t n = 1; n <= (is_quick ? 2 : 4); n *= 2) settings.push_back({Integrator::sdirk2, n, tolerance});
  }
  return settings;
}

Point measure(const TimeJob& job, const Setting& setting, const BenchRun& run, const BenchRun& reference) {
  Point point{setting};
  point.position_error = position_error(run, reference, job.model.rest_position);
  point.force_error = force_error(run, reference);
  double total = 0;
  for (const double seconds : run.seconds) total += seconds;
  point.run_time = total / (double(run.seconds.size()) * job.model.tick);
  point.p50 = percentile(run.seconds, 0.5), point.p99 = percentile(run.seconds, 0.99),
  point.p999 = percentile(run.seconds, 0.999);
  point.unconverged = run.unconverged;
  return point;
}

/// One line for each integrator and tolerance, along its substeps, and the front.
reports::Plot diagram(const std::string& title, const std::vector<Point>& points, double Point::*error,
                      const char* what) {
  reports::Plot plot{.title = title, .x_title = "run time [s per simulated s]", .y_title = what};
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
  std::vector<double> cost, errors;
  for (const Point& p : points) cost.push_back(p.run_time), errors.push_back(p.*error);
  for (const std::size_t i : pareto_front(cost, errors)) front.x.push_back(cost[i]), front.y.push_back(errors[i]);
  plot.series.push_back(front);
  return plot;
}

/// Order of the error in the substeps at the tightest tolerance, from the two finest runs whose error the reference can
/// resolve; its own error is up to `gap`.
reports::Table orders(const std::vector<Point>& points, double gap) {
  reports::Table table;
  table.title =
      "Observed order, between the two finest steps that the reference tells apart, at the tightest "
      "tolerance";
  table.columns = {{"integrator", "integrator"}, {"position", "in position", 3}, {"force", "in force", 3}};
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::backward_euler, Integrator::sdirk2}) {
    std::vector<const Point*> own;
    double tightest = 1;
    for (const Point& p : points)
      if (p.setting.integrator == integrator) tightest = std::min(tightest, p.setting.tolerance);
    for (const Point& p : points)
      if (p.setting.integrator == integrator && p.setting.tolerance == tightest && p.position_error > 2 * gap)
        own.push_back(&p);
    if (own.size() < 2) continue;
    const Point &coarse = *own[own.size() - 2], &fine = *own.back();
    const double ratio = std::log(double(fine.setting.substeps) / coarse.setting.substeps);
    table.rows.push_back({std::string(stepping::name_of(integrator)),
                          std::log(coarse.position_error / fine.position_error) / ratio,
                          std::log(coarse.force_error / fine.force_error) / ratio});
  }
  return table;
}

/// Order of SDIRK2 in position where a pin moves what the ball presses, between 2 and 4 substeps.
double order_without_contact(const TimeJob& job, std::int32_t fine) {
  Model model = job.model;
  const BenchMotion motion = move_the_top(model);
  const auto run = [&](std::int32_t substeps) {
    const Setting setting{Integrator::sdirk2, substeps, kReferenceTolerance};
    return run_motion(with_setting(model, setting), motion);
  };
  const BenchRun reference = run(fine);
  const auto error = [&](std::int32_t substeps) {
    return position_error(run(substeps), reference, model.rest_position);
  };
  return std::log2(error(2) / error(4));
}

/// Names the most accurate setting whose tick takes at most the scene's tick at p99, with percentiles over many ticks.
std::string recommendation(const TimeJob& job, std::vector<Point> points) {
  const double tick = job.model.tick;
  const std::string rate =
      output::short_number(1e-3 / tick) + " kHz with " + std::to_string(job.model.sphere_count()) + " spheres";
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.position_error < b.position_error; });
  for (const Point& p : points) {
    if (p.p99 > tick) continue;
    const Model model = with_setting(job.model, p.setting);
    std::vector<double> seconds;
    while (seconds.size() < kTimedTicks) {
      const BenchRun run = run_motion(model, job.motion);
      seconds.insert(seconds.end(), run.seconds.begin(), run.seconds.end());
    }
    const double p99 = percentile(seconds, 0.99);
    if (p99 > tick) continue;
    return job.title + ": the most accurate setting that holds " + rate + " on this machine is " +
           name_of_setting(p.setting) + ": error " + output::short_number(100 * p.position_error, 2) +
           " % in position and " + output::short_number(100 * p.force_error, 2) + " % in force; ticks of " +
           output::short_number(1e3 * percentile(seconds, 0.5), 3) + " ms (p50), " +
           output::short_number(1e3 * p99, 3) + " ms (p99), " +
           output::short_number(1e3 * percentile(seconds, 0.999), 3) + " ms (p99.9).";
  }
  return job.title + ": no setting holds " + rate + " at p99 on this machine.";
}

BenchStudy study(const TimeJob& job, const BenchOptions& options, const std::function<void()>& advance) {
  // The reference and the run with half its step run in parallel; timed runs run alone.
  const std::int32_t fine = options.is_quick ? 8 : 16;
  const auto reference_run = [&](std::int32_t substeps) {
    return run_motion(with_setting(job.model, {Integrator::sdirk2, substeps, kReferenceTolerance}), job.motion);
  };
  std::future<BenchRun> other = std::async(std::launch::async, [&] { return reference_run(fine / 2); });
  const BenchRun reference = reference_run(fine), halved = other.get();
  const double position_gap = position_error(halved, reference, job.model.rest_position),
               force_gap = force_error(halved, reference);
  advance();

  std::vector<Point> points;
  for (const Setting& setting : settings_for(job.model, options.is_quick)) {
    const BenchRun run = run_motion(with_setting(job.model, setting), job.motion);
    if (run.status == stepping::StepStatus::ok) points.push_back(measure(job, setting, run, reference));
  }
  std::vector<double> cost, errors;
  for (const Point& p : points) cost.push_back(p.run_time), errors.push_back(p.position_error);
  for (const std::size_t i : pareto_front(cost, errors)) points[i].is_on_front = true;

  BenchStudy study;
  study.section.key = "time", study.section.title = "Time: " + job.title;
  study.section.plots = {diagram("position", points, &Point::position_error, "relative L2 error in position"),
                         diagram("force", points, &Point::force_error, "relative L2 error in force")};
  study.section.paragraphs = {
      std::to_string(job.model.sphere_count()) + " spheres, " + std::to_string(job.motion.ticks) + " ticks of " +
          output::short_number(1e3 * job.model.tick) +
          " ms, no gravity. Errors are relative differences in L2 over the whole "
          "trajectory, of displacements and of the force on the tool, from a reference: sdirk2 with " +
          std::to_string(fine) + " substeps and tolerance " + output::short_number(kReferenceTolerance) +
          ". The reference itself "
          "differs from the run with half as many substeps by " +
          output::short_number(100 * position_gap, 2) + " % in position and " +
          output::short_number(100 * force_gap, 2) +
          " % in force: an estimate of its own error, not a bound. Errors below that are not told apart.",
      "Numbers in the legend are tolerances; along a line the substeps double."};
  study.sentences = {recommendation(job, points)};
  study.section.paragraphs.push_back(study.sentences[0]);
  study.section.tables = {orders(points, position_gap)};
  if (job.is_pressed) {
    study.section.tables[0].rows.push_back(
        {std::string("sdirk2, without contact"), order_without_contact(job, fine), reports::Cell()});
    study.section.paragraphs.push_back(
        "SDIRK2 is of second order where the motion is smooth and the steps resolve it. In the last row "
        "of the table of orders a pin moves the pressed sphere along the ball's way: where that is 2 and the row above "
        "is less, contacts that begin and end within steps cost the difference, since the force has a kink there.");
  }
  study.points = bench_layout();
  for (const Point& p : points)
    study.points.rows.push_back(
        {std::string("time"), job.title, reports::Cell(), std::string(stepping::name_of(p.setting.integrator)),
         std::int64_t(p.setting.substeps), p.setting.tolerance, reports::Cell(), reports::Cell(),
         std::int64_t(job.model.sphere_count()), p.position_error, p.force_error, p.run_time, 1e3 * p.p50, 1e3 * p.p99,
         1e3 * p.p999, p.unconverged, p.is_on_front ? reports::Cell(std::string("front")) : reports::Cell()});
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
