// Run time at equal error, compared with SUNDIALS: a block of liver is pressed and released. All integrators solve the
// same equations.
//   ctpm_peers_bench                                   all cases: a quarter of an hour
//   ctpm_peers_bench --benchmark_filter=ball/729/kPa   one of them
//   ctpm_peers_bench --benchmark_filter=springs        blocks of masses and springs: see spring_block.h
// "ball": a ball presses 4 mm deep without friction and leaves. Core moves it along a straight line within a tick,
// which is part of core's error. "load": a load on a patch grows and vanishes; only its rate is discontinuous, at three
// moments. There is no gravity, so all start from the same rest state. Times are processor time of one thread. Errors
// are relative L2 differences of all displacements over the whole trajectory from CVODE at rtol 1e-9. The difference of
// ARKODE at its tightest tolerance is printed too. Last come, for each case, the times at errors of 1e-2 and 1e-3,
// interpolated in log-log on the fronts of core and of each SUNDIALS method.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/stepping/step.h"
#include "tests/core/bench/spring_block.h"
#include "tests/core/bench/sundials_runs.h"
#include "tests/core/blocks.h"

namespace ctpm::testing {
namespace {

constexpr double kErrors[] = {1e-2, 1e-3};
constexpr Samples kSamples{5e-3, 40};

enum class Family { core, cvode, cvode_preconditioned, arkode };

struct Point {
  Family family;
  double seconds, error;
};

/// A pressed block of liver in one reading of its viscosity, and the results of the integrators.
struct Case {
  std::string name;
  Model model;
  State start;
  Press press;
  Trajectory reference;
  std::vector<Point> points;
};

/// A ball of 12 mm that presses beside the middle of the top.
void add_ball(Case& c, int edge) {
  c.model.tools = {ball(0.012)};
  const double touch = 0.012 * (edge - 1) + c.model.tools[0].radius + c.model.contact_radius.back();
  c.press.touch = {0.001, 0.002, touch}, c.press.radius = c.model.tools[0].radius;
}

/// A load of 0.5 N on the 5 x 5 spheres in the middle of the top. It grows over the first half of the time and vanishes
/// over the second.
void add_load(Case& c, int edge) {
  const double half = 0.5 * c.press.duration;
  for (int j = edge / 2 - 2; j <= edge / 2 + 2; ++j)
    for (int i = edge / 2 - 2; i <= edge / 2 + 2; ++i)
      for (const double direction : {-1.0, 1.0}) {
        Loads& loads = c.model.loads;
        loads.sphere.push_back((edge * (edge - 1) + j) * edge + i);
        loads.force.push_back({0, 0, direction * 0.5 / 25});
        loads.start.push_back(direction < 0 ? 0 : half), loads.ramp.push_back(half);
      }
}

Case make_case(const std::string& drive, int edge, const std::string& reading, double viscosity) {
  network::Material material = liver_material();
  material.viscosity = viscosity, material.stiffness_scale = 0.29;
  Case c{"liver_press/" + drive + "/" + std::to_string(edge * edge * edge) + "/" + reading,
         make_block_model(edge, edge, edge, network::Structure::ctpm, material),
         {},
         {},
         {},
         {}};
  c.model.contact_friction = 0;  // a grip is no state of an equation
  c.press.depth = 4e-3, c.press.duration = kSamples.interval * kSamples.count;
  drive == "ball" ? add_ball(c, edge) : add_load(c, edge);
  c.start = rest_state(c.model);
  return c;
}

double error_of(const Trajectory& trajectory, const Trajectory& reference) {
  if (trajectory.size() < reference.size()) return INFINITY;
  double off = 0, size = 0;
  for (std::size_t k = 0; k < reference.size(); ++k)
    for (std::size_t i = 0; i < reference[k].size(); ++i) {
      const double apart = trajectory[k][i] - reference[k][i];
      off += apart * apart, size += reference[k][i] * reference[k][i];
    }
  return std::sqrt(off / size);
}

elements::Coordinates displacements(const State& state, const State& start) {
  elements::Coordinates all;
  const auto add = [&](const std::vector<double>& now, const std::vector<double>& then) {
    for (std::size_t i = 0; i < now.size(); ++i) all.push_back(now[i] - then[i]);
  };
  add(state.position.x, start.position.x), add(state.position.y, start.position.y),
      add(state.position.z, start.position.z);
  return all;
}

/// Ticks of one length without substeps, as a device with this sampling rate would drive them.
Run run_core(const Case& c, Integrator integrator, int steps_per_sample, double tolerance) {
  Model model = c.model;
  model.tick = kSamples.interval / steps_per_sample;
  model.solver = {tolerance, 1e-12, 2000, 1, integrator};
  stepping::Stepper stepper(model);
  State state = c.start;
  Run run;
  for (int sample = 1; sample <= kSamples.count; ++sample) {
    for (int k = 0; k < steps_per_sample; ++k) {
      const double start = processor_time();
      Inputs inputs;
      if (!model.tools.empty()) inputs.tool = 0, inputs.position = c.press.centre(double(state.tick + 1) * model.tick);
      const stepping::StepReport report = stepper.step(state, inputs);
      run.seconds += processor_time() - start;
      if (stepping::is_refused(report.status)) return run;
      run.evaluations += report.iterations, ++run.steps;
    }
    run.trajectory.push_back(displacements(state, c.start));
  }
  return run;
}

using Solve = std::function<Run(NetworkOde&)>;

void measure(benchmark::State& bench, Case& c, Family family, const Solve& solve) {
  NetworkOde ode(c.model, c.start, c.press);
  if (c.reference.empty()) c.reference = run_cvode(ode, kSamples, 1e-9, true).trajectory;
  Run run;
  double fastest = INFINITY;
  for (auto _ : bench) {
    run = solve(ode);
    fastest = std::min(fastest, run.seconds);
    bench.SetIterationTime(run.seconds);
  }
  const double simulated = kSamples.interval * double(std::max(run.trajectory.size(), std::size_t(1)));
  const double error = error_of(run.trajectory, c.reference);
  bench.counters["error"] = error, bench.counters["s_per_s"] = fastest / simulated;
  bench.counters["steps"] = double(run.steps), bench.counters["evaluations"] = double(run.evaluations);
  if (std::isfinite(error)) c.points.push_back({family, fastest, error});
}

/// Run time at which the front of a family has the error `wanted`, by log-log interpolation; none if it never reaches
/// it.
std::optional<double> time_at_error(std::vector<Point> points, Family family, double wanted) {
  std::erase_if(points, [&](const Point& p) { return p.family != family; });
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.seconds < b.seconds; });
  const Point* before = nullptr;
  for (const Point& p : points) {
    if (before != nullptr && p.error >= before->error) continue;
    if (p.error <= wanted) {
      if (before == nullptr) return p.seconds;
      const double share = std::log(before->error / wanted) / std::log(before->error / p.error);
      return before->seconds * std::pow(p.seconds / before->seconds, share);
    }
    before = &p;
  }
  return std::nullopt;
}

void print_ratios(const Case& c) {
  if (c.points.empty()) return;
  double check = INFINITY;
  for (const Point& p : c.points)
    if (p.family == Family::arkode) check = std::min(check, p.error);
  std::printf("%s", c.name.c_str());
  if (std::isfinite(check)) std::printf(", reference and ARKODE apart by %.1e", check);
  std::printf("\n");
  const std::pair<Family, const char*> others[] = {
      {Family::cvode, "CVODE"}, {Family::cvode_preconditioned, "CVODE preconditioned"}, {Family::arkode, "ARKODE"}};
  for (const double error : kErrors) {
    const std::optional<double> core = time_at_error(c.points, Family::core, error);
    if (!core) continue;
    std::printf("  at error %g: core %.3f s", error, *core);
    for (const auto& [family, name] : others)
      if (const std::optional<double> time = time_at_error(c.points, family, error))
        std::printf("; %s %.3f s, %.2f times core", name, *time, *time / *core);
    std::printf("\n");
  }
}

void add(Case& c, Family family, const std::string& name, Solve solve) {
  benchmark::RegisterBenchmark(
      (c.name + "/" + name).c_str(),
      [&c, family, solve = std::move(solve)](benchmark::State& bench) { measure(bench, c, family, solve); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->MinTime(0.3);
}

void add_all(Case& c) {
  char name[64];
  const auto add_core = [&](Integrator integrator, int steps, double tolerance) {
    std::snprintf(name, sizeof name, "core/%s/h_us:%g/tolerance:%g", stepping::name_of(integrator),
                  1e6 * kSamples.interval / steps, tolerance);
    add(c, Family::core, name,
        [&c, integrator, steps, tolerance](NetworkOde&) { return run_core(c, integrator, steps, tolerance); });
  };
  for (const double tolerance : {1e-2, 3e-3, 1e-3})
    for (const int steps : {1, 2, 3, 5, 7, 10, 14, 20, 40}) add_core(Integrator::sdirk2, steps, tolerance);
  for (const double tolerance : {1e-2, 1e-4})
    for (const int steps : {5, 20, 80}) add_core(Integrator::backward_euler, steps, tolerance);
  const double longest = stepping::stable_step_bound(c.model);
  const bool is_stiff = longest < 5e-5;
  const int fewest = 5 * int(std::ceil(1e-3 / longest));
  for (int steps = fewest; steps <= (is_stiff ? 2 : 64) * fewest; steps *= 2)
    add_core(Integrator::leapfrog, steps, 1e-4);
  for (const double rtol : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    std::snprintf(name, sizeof name, "rtol:%g", rtol);
    add(c, Family::cvode, std::string("cvode/") + name,
        [rtol](NetworkOde& ode) { return run_cvode(ode, kSamples, rtol, false); });
    add(c, Family::cvode_preconditioned, std::string("cvode_preconditioned/") + name,
        [rtol](NetworkOde& ode) { return run_cvode(ode, kSamples, rtol, true); });
  }
  // Where stability alone limits the step, looser tolerances cost the same.
  for (const double rtol : is_stiff ? std::vector{1e-3, 1e-6} : std::vector{1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
    std::snprintf(name, sizeof name, "arkode/rtol:%g", rtol);
    add(c, Family::arkode, name, [rtol](NetworkOde& ode) { return run_arkode(ode, kSamples, rtol); });
  }
}

}  // namespace
}  // namespace ctpm::testing

int main(int argc, char** argv) {
  using namespace ctpm::testing;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  std::vector<std::unique_ptr<Case>> cases;
  for (const int edge : {9, 17})
    for (const char* drive : {"ball", "load"})
      for (const auto& [reading, viscosity] : {std::pair{"Pa_s", 5e3}, std::pair{"kPa_s", 5e6}}) {
        cases.push_back(std::make_unique<Case>(make_case(drive, edge, reading, viscosity)));
        add_all(*cases.back());
      }
  add_spring_blocks();
  benchmark::RunSpecifiedBenchmarks();
  for (const auto& c : cases) print_ratios(*c);
}
