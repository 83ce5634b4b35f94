// Cost of forces and ticks of cubic blocks of liver, beside a plain loop over springs and a loop that only streams the
// same bytes.
//   ctpm_core_bench                             all benchmarks
//   ctpm_core_bench --benchmark_filter=forces   some of them
// "per_spring" is time per axial element. Compare results of one run only, since machines and their load differ.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/elements/elements.h"
#include "core/inversion/resistance.h"
#include "core/model/fields.h"
#include "core/model/nearest_rank.h"
#include "core/stepping/sleepers.h"
#include "core/stepping/step.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

constexpr double kPascal = 5e3, kKilopascal = 5e6;  // v1 of the liver in both readings of its unit [Pa s/m]

/// Spheres along one edge of a cubic block of about `spheres` spheres.
int edge_of(std::int64_t spheres) { return int(std::lround(std::cbrt(double(spheres)))); }

Model make_model(std::int64_t spheres, network::Structure structure, double viscosity,
                 double inversion_resistance = 0) {
  network::Material material = testing::liver_material();
  material.viscosity = viscosity, material.stiffness_scale = 0.29;
  const int n = edge_of(spheres);
  Model model = testing::make_block_model(n, n, n, structure, material, 0.012, inversion_resistance);
  model.tools = {testing::ball(0.006)};
  return model;
}

void report(benchmark::State& run, const Model& model) {
  run.counters["spheres"] = double(model.sphere_count());
  run.counters["per_spring"] = benchmark::Counter(
      double(model.axial.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void forces(benchmark::State& run, network::Structure structure, double viscosity) {
  const Model model = make_model(run.range(0), structure, viscosity);
  parallel::Team team(int(run.range(1)));
  elements::Elements elements(model, team);
  State state = rest_state(model);
  testing::shake(state, 1e-4, 1e-3);
  elements::Coordinates force(3 * model.sphere_count());
  for (auto _ : run) elements.add_forces(state, force), benchmark::DoNotOptimize(force.data());
  report(run, model);
}

/// Spring forces by a plain loop without damping, cutting, softening, constraints or slabs. The excess of
/// forces/springs over it is the overhead of unused features.
void plain_springs(benchmark::State& run) {
  const Model model = make_model(run.range(0), network::Structure::mass_spring, 0);
  const AxialElements& axial = model.axial;
  State state = rest_state(model);
  testing::shake(state, 1e-4, 1e-3);
  const double *x = state.position.x.data(), *y = state.position.y.data(), *z = state.position.z.data();
  const std::size_t n = model.sphere_count();
  elements::Coordinates force(3 * n);
  double *fx = force.data(), *fy = fx + n, *fz = fy + n;
  for (auto _ : run) {
    for (std::size_t i = 0; i < axial.size(); ++i) {
      const auto a = std::size_t(axial.a[i]), b = std::size_t(axial.b[i]);
      const double dx = x[b] - x[a], dy = y[b] - y[a], dz = z[b] - z[a];
      const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
      const double pull = axial.k[i] * (length - axial.rest_length[i]) / length;
      fx[a] += pull * dx, fy[a] += pull * dy, fz[a] += pull * dz;
      fx[b] -= pull * dx, fy[b] -= pull * dy, fz[b] -= pull * dz;
    }
    benchmark::DoNotOptimize(force.data());
    benchmark::ClobberMemory();
  }
  report(run, model);
}

/// The least memory traffic of a force evaluation: positions, velocities and forces once.
void streaming(benchmark::State& run) {
  const Model model = make_model(run.range(0), network::Structure::mass_spring, 0);
  const std::size_t n = 3 * model.sphere_count();
  std::vector<double> position(n, 1), velocity(n, 2), force(n);
  for (auto _ : run) {
    for (std::size_t i = 0; i < n; ++i) force[i] += position[i] + velocity[i];
    benchmark::DoNotOptimize(force.data());
    benchmark::ClobberMemory();
  }
  report(run, model);
}

/// As scenes have it by default [m/s].
constexpr double kEnough = 2e-6;

/// How a tick is solved: as a scene's, with the integrator that the Model gets, or to a residual alone.
std::optional<SolverSettings> as_scenes() { return std::nullopt; }
std::optional<SolverSettings> at_residual(double tolerance) {
  SolverSettings solver;
  solver.integrator = Integrator::backward_euler;
  solver.tolerance = tolerance, solver.velocity_floor = 1e-15, solver.max_iterations = 2000;
  return solver;
}

/// Reports the least time of a tick, which other programs disturb least, and percentiles.
void report_times(benchmark::State& run, const std::vector<double>& times) {
  run.counters["least_ms"] = 1e3 * percentile(times, 0);
  run.counters["p50_ms"] = 1e3 * percentile(times, 0.5), run.counters["p99_ms"] = 1e3 * percentile(times, 0.99);
}

/// A tick, whose time [s] is added to `times`.
stepping::StepReport timed_step(stepping::Stepper& stepper, State& state, const Inputs& inputs,
                                std::vector<double>& times) {
  const auto start = std::chrono::steady_clock::now();
  const stepping::StepReport report = stepper.step(state, inputs);
  times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return report;
}

/// The hand after `tick` ticks: it lowers the first tool at 20 mm/s towards the top of a block of n layers.
Inputs lower(std::int64_t tick, int n, double gap) {
  Inputs inputs;
  inputs.tool = 0;
  inputs.position = {0.001, 0.002, 0.012 * (n - 1) + gap - 2e-5 * double(tick)};
  return inputs;
}

/// A ball presses at 20 mm/s, each solve starting from the last velocities; percentiles of the tick, iterations of its
/// solves, and ticks with a solve that stopped at its count.
void ticks(benchmark::State& run, double viscosity, const std::optional<SolverSettings>& solver,
           double inversion_resistance = 0, elements::InstructionSet set = elements::best_instruction_set()) {
  Model model = make_model(run.range(0), network::Structure::ctpm, viscosity, inversion_resistance);
  model.solver.velocity_enough = kEnough;
  if (solver) model.solver = *solver;
  stepping::Stepper stepper(model, {.threads = int(run.range(1)), .instruction_set = set});
  State state = rest_state(model);
  std::vector<double> times;
  double iterations = 0, unconverged = 0;
  for (auto _ : run) {
    const Inputs inputs = lower(state.tick, edge_of(run.range(0)), 0.006 + 0.006);
    const stepping::StepReport report = timed_step(stepper, state, inputs, times);
    iterations += report.iterations, unconverged += report.status == stepping::StepStatus::not_converged;
  }
  report_times(run, times);
  run.counters["iterations"] = iterations / double(times.size()), run.counters["unconverged"] = unconverged;
  run.SetLabel(stepping::name_of(stepper.integrator().integrator));
  report(run, model);
}

/// Largest errors of a press against the same steps solved to rounding.
struct PressErrors {
  double force = 0;     ///< relative, where the force is above a tenth of its greatest [1]
  double position = 0;  ///< of any sphere [m]
};

Model solved_to_rounding(Model model) {
  model.solver.tolerance = 1e-9, model.solver.velocity_floor = 1e-15, model.solver.velocity_enough = 0;
  model.solver.max_iterations = 5000;
  return model;
}

/// Repeats `ticks` ticks of a press on a block of n layers, and compares every tenth.
PressErrors errors_of_press(const Model& model, int threads, int n, std::int64_t ticks) {
  const Model exact = solved_to_rounding(model);
  stepping::Stepper stepper(model, {.threads = threads}), to_rounding(exact);
  State state = rest_state(model);
  std::vector<double> forces, misses;
  PressErrors errors;
  while (state.tick < ticks) {
    const Inputs inputs = lower(state.tick, n, 0.006);
    const bool is_compared = state.tick % 10 == 9;
    State converged = is_compared ? state : State{};
    const Vec3 force = stepper.step(state, inputs).tool_force;
    if (!is_compared) continue;
    const Vec3 wanted = to_rounding.step(converged, inputs).tool_force;
    forces.push_back(norm(wanted)), misses.push_back(norm(force - wanted));
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      errors.position = std::max(errors.position, norm(state.position[i] - converged.position[i]));
  }
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (forces[i] > 0.1 * *std::max_element(forces.begin(), forces.end()))
      errors.force = std::max(errors.force, misses[i] / forces[i]);
  return errors;
}

/// A ball presses the surface of a block of stiff liver at 20 mm/s, as a scene's Model is solved. Beside the times: the
/// errors of the same ticks, which a second run finds, since solving to rounding in between would empty the caches.
void presses(benchmark::State& run, Integrator integrator, double velocity_enough = kEnough) {
  network::Material material = testing::liver_material();
  material.stiffness_scale = 0.29;
  const int n = edge_of(run.range(0)), threads = int(run.range(1));
  Model model = testing::make_skinned_block(n, n, n, network::Structure::ctpm, 0.006, material);
  model.tools = {testing::ball(0.006)};
  testing::use_integrator(model, integrator);
  model.solver.velocity_enough = velocity_enough;
  stepping::Stepper stepper(model, {.threads = threads});
  State state = rest_state(model);
  std::vector<double> times;
  double iterations = 0;
  for (auto _ : run) {
    const Inputs inputs = lower(state.tick, n, 0.006);
    const stepping::StepReport report = timed_step(stepper, state, inputs, times);
    iterations += report.iterations;
  }
  const PressErrors errors = errors_of_press(model, threads, n, state.tick);
  report_times(run, times);
  run.counters["iterations"] = iterations / double(times.size());
  run.counters["force_error"] = errors.force, run.counters["position_error_nm"] = 1e9 * errors.position;
  report(run, model);
}

/// Organs side by side, blocks of stiff liver with surfaces, of which a ball presses the first.
Model row_of_organs(int n, int organs, double sleep_bound) {
  Model model;
  for (int k = 0; k < organs; ++k) {
    FilledOrgan organ = testing::make_block(n, n, n);
    for (Vec3& centre : organ.centre) centre.x += 0.012 * (n + 2) * k;
    testing::add_faces(organ, 0.006);
    network::OrganSettings settings;
    settings.name = std::to_string(k), settings.structure = network::Structure::ctpm;
    settings.tiling = network::Tiling::three_spheres;
    settings.material = testing::liver_material(), settings.material.stiffness_scale = 0.29;
    for (int i = 0; i < n * n; ++i) settings.anchored.push_back(i);
    CTPM_CHECK(bool(network::add_organ(model, organ, settings)), "a block of the benchmark is valid");
  }
  model.contact_friction = 0.3, model.organs_meet = true;
  model.tools = {testing::ball(0.006)};
  testing::use_integrator(model, Integrator::backward_euler);
  model.solver.velocity_enough = kEnough, model.solver.sleep_bound = sleep_bound;
  return model;
}

/// A press of the first of some organs, while the others stand still: with `sleep_bound` [m/s] they sleep. Beside the
/// times: the share of the spheres that slept, and errors against the same press with all of them awake, solved to
/// rounding.
void organs(benchmark::State& run, double sleep_bound) {
  const int n = edge_of(run.range(0)), count = int(run.range(1)), threads = int(run.range(2));
  const Model model = row_of_organs(n, count, sleep_bound);
  const Model all_awake = solved_to_rounding(row_of_organs(n, count, 0));
  stepping::Stepper stepper(model, {.threads = threads}), whole(all_awake, {.threads = threads});
  const auto until_all_sleep = [](stepping::Stepper& of, const Model& its) {
    State state = rest_state(its);
    for (int tick = 0; tick <= stepping::Sleepers::ticks_before_sleep(its); ++tick) (void)of.step(state, {});
    state.tick = 0;
    return state;
  };
  const State start = until_all_sleep(stepper, model);
  State state = start, awake = until_all_sleep(whole, all_awake);
  std::vector<double> times;
  double asleep = 0;
  for (auto _ : run) {
    const Inputs inputs = lower(state.tick, n, 0.006);
    const stepping::StepReport report = timed_step(stepper, state, inputs, times);
    asleep += report.asleep;
  }
  report_times(run, times);
  double peak = 0, force_error = 0, position_error = 0;
  for (state = start; state.tick < std::int64_t(times.size());) {
    const Inputs inputs = lower(state.tick, n, 0.006);
    const Vec3 force = stepper.step(state, inputs).tool_force, wanted = whole.step(awake, inputs).tool_force;
    peak = std::max(peak, norm(wanted)), force_error = std::max(force_error, norm(force - wanted));
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      position_error = std::max(position_error, norm(state.position[i] - awake.position[i]));
  }
  run.counters["asleep"] = asleep / double(times.size()) / double(model.sphere_count());
  run.counters["force_error"] = force_error / peak, run.counters["position_error_nm"] = 1e9 * position_error;
  report(run, model);
}

/// Search for cells that are turned inside out, of which there are none. Turned tissue takes the slower of two passes.
void inverted_cells(benchmark::State& run, bool is_turned) {
  const Model model = make_model(run.range(0), network::Structure::ctpm, kPascal, 10);
  parallel::Team team(int(run.range(1)));
  elements::Elements elements(model, team);
  inversion::Resistance resistance(model, elements.slabs(), team,
                                   elements::kernels_for(elements::best_instruction_set()));
  State state = rest_state(model);
  testing::shake(state, 1e-4);
  if (is_turned)
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      state.position.set(i, rotate({0.8, 0, 0.6, 0}, state.position[i]));
  for (auto _ : run) benchmark::DoNotOptimize(resistance.count_inverted(state));
  report(run, model);
  run.counters["cells"] = double(model.tissue_cells.size());
}

/// Bytes of Model and State per sphere, with all tissue features and with none.
void memory(benchmark::State& run, network::Structure structure, double viscosity) {
  const Model model = make_model(run.range(0), structure, viscosity);
  const State state = rest_state(model);
  double bytes = 0;
  const auto count = [&](std::string_view, const auto& member) {
    if constexpr (requires { member.data(); }) bytes += double(member.size() * sizeof(*member.data()));
  };
  for (auto _ : run) bytes = 0, for_each_field(model, count), for_each_field(state, count);
  run.counters["bytes_per_sphere"] = bytes / double(model.sphere_count());
}

BENCHMARK(plain_springs)->Arg(1000)->Arg(10000)->Arg(100000);
BENCHMARK(streaming)->Arg(1000)->Arg(10000)->Arg(100000);
BENCHMARK_CAPTURE(forces, springs, network::Structure::mass_spring, 0.0)
    ->ArgsProduct({{1000, 10000, 100000}, {1, 2}})
    ->UseRealTime();
BENCHMARK_CAPTURE(forces, two_sphere_tpms, network::Structure::tpm, kPascal)
    ->ArgsProduct({{1000, 10000, 100000}, {1, 2}})
    ->UseRealTime();
BENCHMARK_CAPTURE(forces, ctpm, network::Structure::ctpm, kPascal)
    ->ArgsProduct({{1000, 10000, 100000}, {1, 2}})
    ->UseRealTime();
BENCHMARK_CAPTURE(ticks, stiff_liver, kKilopascal, as_scenes())
    ->ArgsProduct({{729, 4913, 10648}, {1, 2}})
    ->Iterations(500)
    ->UseRealTime();
BENCHMARK_CAPTURE(ticks, stiff_liver_to_1e_3, kKilopascal, at_residual(1e-3))
    ->ArgsProduct({{729, 5832, 10648, 46656}, {1, 2}})
    ->Iterations(200)
    ->UseRealTime();
// What is fast with the widest vectors may be slow with narrower ones, and most processors have those alone.
BENCHMARK_CAPTURE(ticks, stiff_liver_to_1e_3_avx2, kKilopascal, at_residual(1e-3), 0, elements::InstructionSet::avx2)
    ->ArgsProduct({{5832, 46656}, {2}})
    ->Iterations(200)
    ->UseRealTime();
BENCHMARK_CAPTURE(ticks, stiff_liver_to_1e_3_baseline, kKilopascal, at_residual(1e-3), 0,
                  elements::InstructionSet::baseline)
    ->ArgsProduct({{5832, 46656}, {2}})
    ->Iterations(200)
    ->UseRealTime();
BENCHMARK_CAPTURE(ticks, stiff_liver_to_1e_6, kKilopascal, at_residual(1e-6))
    ->ArgsProduct({{729, 5832}, {1, 2}})
    ->Iterations(500)
    ->UseRealTime();
BENCHMARK_CAPTURE(presses, backward_euler, Integrator::backward_euler)
    ->ArgsProduct({{5832, 10648}, {1, 2}})
    ->Iterations(500)
    ->UseRealTime();
BENCHMARK_CAPTURE(presses, backward_euler_to_the_floor, Integrator::backward_euler, 0)
    ->ArgsProduct({{5832, 10648}, {1, 2}})
    ->Iterations(500)
    ->UseRealTime();
BENCHMARK_CAPTURE(presses, sdirk2, Integrator::sdirk2)
    ->ArgsProduct({{5832, 10648}, {1, 2}})
    ->Iterations(500)
    ->UseRealTime();
BENCHMARK_CAPTURE(organs, all_awake, 0.0)->ArgsProduct({{4913}, {1, 10}, {2}})->Iterations(500)->UseRealTime();
BENCHMARK_CAPTURE(organs, that_sleep, 1e-5)->ArgsProduct({{4913}, {1, 10}, {2}})->Iterations(500)->UseRealTime();
BENCHMARK_CAPTURE(ticks, liver_not_stiff, kPascal, as_scenes())
    ->ArgsProduct({{4913, 29791}, {1, 2}})
    ->Iterations(500)
    ->UseRealTime();
BENCHMARK_CAPTURE(ticks, stiff_liver_resisting, kKilopascal, as_scenes(), 10.0)
    ->ArgsProduct({{729, 4913}, {1, 2}})
    ->Iterations(500)
    ->UseRealTime();
BENCHMARK_CAPTURE(ticks, liver_not_stiff_resisting, kPascal, as_scenes(), 10.0)
    ->ArgsProduct({{4913, 29791}, {1, 2}})
    ->Iterations(500)
    ->UseRealTime();
BENCHMARK_CAPTURE(inverted_cells, upright, false)->ArgsProduct({{4913, 29791}, {1, 2}})->UseRealTime();
BENCHMARK_CAPTURE(inverted_cells, turned, true)->ArgsProduct({{4913, 29791}, {1, 2}})->UseRealTime();
BENCHMARK_CAPTURE(memory, springs, network::Structure::mass_spring, 0.0)->Arg(5000);
BENCHMARK_CAPTURE(memory, ctpm, network::Structure::ctpm, kKilopascal)->Arg(5000);

}  // namespace
}  // namespace ctpm

BENCHMARK_MAIN();
