#include "tests/core/bench/spring_block.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "core/stepping/integrator.h"
#include "core/stepping/step.h"
#include "tests/core/bench/sundials_runs.h"

namespace ctpm::testing {
namespace {

constexpr double kSpacing = 12e-3, kMass = 1.83e-3, kPull = 0.13;  // [m], [kg], [N]
constexpr double kNear = 188.5, kDashpot = 0.5, kFar = 251;        // [N/m], [N s/m], [N/m]
constexpr Samples kSamples{10e-3, 100};
constexpr int kReferenced = 22;  ///< longest edge for which a reference is computed

struct Block {
  int edge;
  Model model;
  std::size_t loaded;      ///< the mass that is pulled
  Trajectory reference{};  ///< empty until it is asked for
};

/// Springs from each mass to the one `reach` places on along each axis.
void add_springs(Model& model, int edge, int reach, AxialLaw law, double k, double c) {
  AxialElements& axial = model.axial;
  const int step[3] = {1, edge, edge * edge};
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < edge * edge * edge; ++i) {
      if (i / step[axis] % edge + reach >= edge) continue;
      axial.a.push_back(i), axial.b.push_back(i + reach * step[axis]), axial.law.push_back(law);
      axial.rest_length.push_back(reach * kSpacing), axial.k.push_back(k), axial.c.push_back(c);
    }
}

Block make_block(int edge) {
  Block block{edge, {}, std::size_t(edge / 2 * edge + edge / 2)};
  Model& model = block.model;
  const int count = edge * edge * edge;
  for (int i = 0; i < count; ++i) {
    const int x = i % edge, y = i / edge % edge, z = i / edge / edge;
    model.rest_position.push_back(kSpacing * Vec3{double(x), double(y), double(z)});
    model.cell.push_back({x, y, z});
    model.held_axes.push_back(z == edge - 1 ? kAnchored : 0);
  }
  model.mass.assign(std::size_t(count), kMass), model.contact_radius.assign(std::size_t(count), kSpacing / 3);
  model.layer.assign(std::size_t(count), 1);
  model.organs = {{.name = "block", .first = 0, .count = count, .sphere_radius = kSpacing / 3, .spacing = kSpacing}};
  add_springs(model, edge, 1, AxialLaw::kelvin_unit, kNear, kDashpot);
  add_springs(model, edge, 2, AxialLaw::spring, kFar, 0);
  model.gravity = {0, 0, -9.81};
  Loads& loads = model.loads;
  loads.sphere = {std::int32_t(block.loaded)}, loads.force.push_back({0, 0, -kPull});
  loads.start = {0}, loads.ramp = {0.05};
  return block;
}

Vec3 loaded_at(const Block& block, const elements::Coordinates& all) {
  const std::size_t n = block.model.sphere_count(), i = block.loaded;
  return {all[i], all[n + i], all[2 * n + i]};
}

/// Infinite for a run that failed.
double error_of(const Block& block, const Trajectory& trajectory) {
  if (trajectory.size() < block.reference.size()) return INFINITY;
  double off = 0, size = 0;
  for (std::size_t k = 0; k < block.reference.size(); ++k) {
    const Vec3 wanted = loaded_at(block, block.reference[k]);
    off = std::max(off, norm(loaded_at(block, trajectory[k]) - wanted)), size = std::max(size, norm(wanted));
  }
  return off / size;
}

/// Ticks of 1 ms; explicit ones in as many steps as are stable.
Run run_core(const Block& block, Integrator integrator) {
  Model model = block.model;
  model.solver.integrator = integrator;
  if (integrator == Integrator::leapfrog)
    model.solver.substeps = std::int32_t(std::ceil(model.tick / stepping::stable_step_bound(model)));
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  const State start = state;
  const auto ticks = int(std::lround(kSamples.interval / model.tick));
  Run run;
  for (int sample = 0; sample < kSamples.count; ++sample) {
    const double began = processor_time();
    for (int k = 0; k < ticks; ++k)
      if (stepping::is_refused(stepper.step(state, {}).status)) return run;
    run.seconds += processor_time() - began;
    elements::Coordinates all;
    for (const auto axis : {&Vec3Array::x, &Vec3Array::y, &Vec3Array::z})
      for (std::size_t i = 0; i < model.sphere_count(); ++i)
        all.push_back((state.position.*axis)[i] - (start.position.*axis)[i]);
    run.trajectory.push_back(std::move(all));
  }
  return run;
}

using Solve = std::function<Run(const Block&, NetworkOde&)>;

void measure(benchmark::State& bench, Block& block, const Solve& solve) {
  // Sizes for tolerances: what it moves, and in which time.
  constexpr double kMoved = 5e-3, kIn = 0.2;
  NetworkOde ode(block.model, rest_state(block.model), {.touch = {}, .depth = kMoved, .duration = kIn});
  if (block.reference.empty() && block.edge <= kReferenced)
    block.reference = run_cvode(ode, kSamples, 1e-10, false).trajectory;
  double fastest = INFINITY;
  Run run;
  for (auto _ : bench) {
    run = solve(block, ode);
    fastest = std::min(fastest, run.seconds);
    bench.SetIterationTime(run.seconds);
  }
  const double steps = 1e3 * kSamples.interval * kSamples.count;
  bench.counters["springs"] = double(block.model.axial.size());
  bench.counters["ns"] = 1e9 * fastest / steps / double(block.model.axial.size());
  if (!block.reference.empty()) bench.counters["error"] = error_of(block, run.trajectory);
}

}  // namespace

void add_spring_blocks() {
  const std::pair<const char*, Solve> solvers[] = {
      {"core/leapfrog", [](const Block& b, NetworkOde&) { return run_core(b, Integrator::leapfrog); }},
      {"core/sdirk2", [](const Block& b, NetworkOde&) { return run_core(b, Integrator::sdirk2); }},
      {"core/backward_euler", [](const Block& b, NetworkOde&) { return run_core(b, Integrator::backward_euler); }},
      {"arkode/rtol:1e-4", [](const Block&, NetworkOde& ode) { return run_arkode(ode, kSamples, 1e-4); }},
      {"cvode/rtol:1e-4", [](const Block&, NetworkOde& ode) { return run_cvode(ode, kSamples, 1e-4, false); }},
      {"cvode/rtol:1e-8", [](const Block&, NetworkOde& ode) { return run_cvode(ode, kSamples, 1e-8, false); }}};
  for (const int edge : {10, 22, 46}) {
    const auto block = std::make_shared<Block>(make_block(edge));
    for (const auto& [name, solve] : solvers)
      benchmark::RegisterBenchmark(("springs/" + std::to_string(edge) + "/" + name).c_str(),
                                   [block, solve = solve](benchmark::State& bench) { measure(bench, *block, solve); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond)
          ->Iterations(edge > kReferenced ? 1 : 3);
  }
}

}  // namespace ctpm::testing
