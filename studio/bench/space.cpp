// Error against run time for the sphere radius, at one tool and path.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "studio/bench/bench.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

struct PressedFilling {
  double radius = 0;  ///< [m]
  std::int64_t layers = 0, spheres = 0;
  BenchRun run;  ///< its positions are those of the surface's vertices
};

/// Positions of the surface's vertices for spheres at `position`.
Vec3Array surface_at(const Surface& surface, const Vec3Array& position) {
  const SurfaceBinding& binding = surface.binding;
  Vec3Array vertices(surface.vertex.size());
  for (std::size_t v = 0; v < surface.vertex.size(); ++v)
    for (auto e = std::size_t(binding.first[v]); e < std::size_t(binding.first[v + 1]); ++e)
      vertices.add(v, binding.weight[e] * position[std::size_t(binding.sphere[e])]);
  return vertices;
}

/// The ball comes down on the highest point of the surface, 6 mm at 60 mm/s, and stays.
BenchMotion press(const Surface& surface, double ball_radius, double tick) {
  constexpr double kDepth = 6e-3, kSpeed = 0.06;
  const Vec3 top =
      *std::max_element(surface.vertex.begin(), surface.vertex.end(), [](Vec3 a, Vec3 b) { return a.z < b.z; });
  BenchMotion motion;
  motion.ticks = std::llround(1.2 * kDepth / kSpeed / tick);
  motion.hand = [=](std::int64_t t) {
    Inputs inputs;
    inputs.tool = 0;
    inputs.position = top + Vec3{0, 0, ball_radius - std::min(kDepth, kSpeed * double(t + 1) * tick)};
    return inputs;
  };
  return motion;
}

double run_time_of(const BenchRun& run, double tick) {
  return std::accumulate(run.seconds.begin(), run.seconds.end(), 0.0) / (double(run.seconds.size()) * tick);
}

Result<PressedFilling> fill_and_press(const std::string& path, double radius, double contact_stiffness) {
  Result<loading::LoadedScene> scene = loading::load_whole_scene(path, {}, [&](scenes::SceneSpec& spec) {
    spec.gravity = {}, spec.organs[0].fill.radius = spec.organs[0].fill.gap = radius;
    if (contact_stiffness > 0) spec.contact_stiffness = contact_stiffness;
  });
  if (!scene) return scene.errors();
  const Model& model = scene->built.model;
  const Surface& surface = scene->organs[0].surface;
  PressedFilling filling{radius, model.organs[0].layer_count, std::int64_t(model.sphere_count()), {}};
  filling.run = run_motion(model, press(surface, model.tools[0].radius, model.tick));
  if (filling.run.status != stepping::StepStatus::ok)
    return Error{path, "the press diverged at r = " + output::short_number(1e3 * radius) + " mm", ""};
  for (Vec3Array& position : filling.run.position) position = surface_at(surface, position);
  return filling;
}

}  // namespace

Result<BenchStudy> run_bench_space(const BenchOptions& options, const BenchProgress& progress) {
  const std::string path = options.shipped + "/kidney.json";
  const Result<loading::LoadedScene> shipped = loading::load_whole_scene(path);
  if (!shipped) return shipped.errors();
  const double radius = shipped->scene.spec.organs[0].fill.radius, tick = shipped->built.model.tick;
  const Surface& surface = shipped->organs[0].surface;
  const std::vector<double> shares =
      options.is_quick ? std::vector{2.0, 1.5, 1.25, 1.0, 0.75} : std::vector{1.5, 1.0, 0.75, 0.5, 0.375, 0.25};
  std::vector<PressedFilling> fillings;
  for (const double share : shares) {
    Result<PressedFilling> filling = fill_and_press(path, share * radius, shipped->built.model.contact_k);
    if (!filling) return filling.errors();
    fillings.push_back(std::move(*filling));
    progress(std::int64_t(fillings.size()), std::int64_t(shares.size()));
  }
  const PressedFilling& finest = fillings.back();
  Vec3Array rest;
  for (const Vec3& v : surface.vertex) rest.push_back(v);

  BenchStudy study;
  reports::Section& section = study.section;
  section.key = "space",
  section.title = "Space: kidney, press, sphere radius down to " + output::short_number(1e3 * finest.radius) + " mm";
  study.points = bench_layout();
  reports::Table table;
  table.columns = {{"radius_mm", "r [mm]", 3},
                   {"layers", "layers"},
                   {"spheres", "spheres"},
                   {"force_n", "force at 6 mm [N]"},
                   {"position_error", "error in position", 3},
                   {"force_error", "error in force", 3},
                   {"run_time_s_per_s", "run time [s per s]", 3}};
  reports::Plot work{
      .title = "against the finest", .x_title = "run time [s per simulated s]", .y_title = "relative L2 error"};
  work.is_log_x = work.is_log_y = true;
  reports::Plot convergence = work;
  convergence.title = "over the radius", convergence.x_title = "sphere radius [mm]";
  reports::Series position{.name = "surface", .colour = 0}, force{.name = "force on the ball", .colour = 1};
  reports::Series position_r = position, force_r = force;
  std::vector<double> cost, errors;
  for (const PressedFilling& f : fillings) {
    const double run_time = run_time_of(f.run, tick), off = position_error(f.run, finest.run, rest),
                 force_off = force_error(f.run, finest.run);
    table.rows.push_back({1e3 * f.radius, f.layers, f.spheres, norm(f.run.force.back()), off, force_off, run_time});
    study.points.rows.push_back({std::string("space"), std::string("kidney"), std::string("ctpm"), reports::Cell(),
                                 reports::Cell(), reports::Cell(), 1e3 * f.radius, f.layers, f.spheres, off, force_off,
                                 run_time, 1e3 * percentile(f.run.seconds, 0.5), 1e3 * percentile(f.run.seconds, 0.99),
                                 1e3 * percentile(f.run.seconds, 0.999), f.run.unconverged, reports::Cell()});
    if (&f == &finest) continue;
    position.x.push_back(run_time), position.y.push_back(off), force.x.push_back(run_time),
        force.y.push_back(force_off);
    position_r.x.push_back(1e3 * f.radius), position_r.y.push_back(off);
    force_r.x.push_back(1e3 * f.radius), force_r.y.push_back(force_off);
    cost.push_back(run_time), errors.push_back(off);
  }
  reports::Series front{.name = "Pareto front (surface)", .stroke = reports::Stroke::marks, .colour = 0};
  for (const std::size_t i : pareto_front(cost, errors)) {
    front.x.push_back(cost[i]), front.y.push_back(errors[i]);
    study.points.rows[i].back() = reports::Cell(std::string("front"));
  }
  work.series = {position, force, front}, convergence.series = {position_r, force_r};
  section.plots = {work, convergence}, section.tables = {table};
  // Least-squares line through the logarithms.
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double x = std::log(position_r.x[i]), y = std::log(errors[i]);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double order = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  std::size_t best = fillings.size();
  for (std::size_t i = 0; i < fillings.size(); ++i)
    if (percentile(fillings[i].run.seconds, 0.99) <= tick) best = i;
  section.paragraphs = {
      "A ball comes down 6 mm on the kidney's highest point at 60 mm/s and stays, whatever the filling; gap "
      "= r, the "
      "contact's stiffness is that of the shipped filling. Errors are relative differences in L2 over time "
      "from the "
      "finest filling, of the displacements of the drawn surface's vertices and of the force on the ball. "
      "The surface's "
      "error falls with order " +
      output::short_number(order, 2) + " in the radius."};
  const auto& seconds = best < fillings.size() ? fillings[best].run.seconds : fillings[0].run.seconds;
  study.sentences = {best == fillings.size()
                         ? "kidney: no filling holds 1 kHz at p99 on this machine."
                         : "kidney: the finest filling that holds 1 kHz on this machine has r = " +
                               output::short_number(1e3 * fillings[best].radius) + " mm (" +
                               std::to_string(fillings[best].spheres) + " spheres): error " +
                               output::short_number(100 * position_error(fillings[best].run, finest.run, rest), 2) +
                               " % of the surface; ticks of " +
                               output::short_number(1e3 * percentile(seconds, 0.5), 3) + " ms (p50), " +
                               output::short_number(1e3 * percentile(seconds, 0.99), 3) + " ms (p99), " +
                               output::short_number(1e3 * percentile(seconds, 0.999), 3) + " ms (p99.9, of " +
                               std::to_string(seconds.size()) + " ticks)."};
  section.paragraphs.push_back(study.sentences[0]);
  return study;
}

}  // namespace ctpm::bench
