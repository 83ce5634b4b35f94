// Shared by all studies: timed runs, errors, the Pareto front.

#include <time.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/model/result.h"
#include "core/stepping/step.h"
#include "studio/bench/bench.h"
#include "studio/output/number_text.h"

namespace ctpm::bench {
namespace {

/// Processor time of this thread [s]: a tick of one thread is all in it.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace

std::vector<std::string> scenes_of(const BenchOptions& options) {
  return options.scenes.empty() ? std::vector{options.shipped + "/liver.json"} : options.scenes;
}

BenchRun run_motion(const Model& model, const BenchMotion& motion) {
  BenchRun run;
  stepping::Stepper stepper(model);
  State state = motion.start ? *motion.start : rest_state(model);
  for (std::int64_t tick = 0; tick < motion.ticks; ++tick) {
    const Inputs inputs = motion.hand(tick);
    const double start = thread_seconds();
    const stepping::StepReport report = stepper.step(state, inputs);
    run.seconds.push_back(thread_seconds() - start);
    run.fallbacks += report.fallbacks > 0;
    if (report.status == stepping::StepStatus::not_converged) {
      ++run.unconverged;
    } else if (report.status != stepping::StepStatus::ok) {
      run.status = report.status;
      return run;
    }
    run.position.push_back(state.position), run.force.push_back(report.tool_force);
    run.asleep.push_back(report.asleep);
  }
  return run;
}

double position_error(const BenchRun& run, const BenchRun& reference, const Vec3Array& start,
                      const std::vector<double>& weight) {
  double off = 0, size = 0;
  for (std::size_t t = 0; t < std::min(run.position.size(), reference.position.size()); ++t) {
    CTPM_CHECK(start.size() <= run.position[t].size() && start.size() <= reference.position[t].size(),
               "places that are compared are in both runs");
    for (std::size_t i = 0; i < start.size(); ++i) {
      const Vec3 apart = run.position[t][i] - reference.position[t][i], way = reference.position[t][i] - start[i];
      const double counts = weight.empty() ? 1 : weight[i];
      off += counts * dot(apart, apart), size += counts * dot(way, way);
    }
  }
  return size > 0 ? std::sqrt(off / size) : 0;
}

double force_error(const BenchRun& run, const BenchRun& reference) {
  double off = 0, size = 0;
  for (std::size_t t = 0; t < std::min(run.force.size(), reference.force.size()); ++t) {
    const Vec3 apart = run.force[t] - reference.force[t];
    off += dot(apart, apart), size += dot(reference.force[t], reference.force[t]);
  }
  return size > 0 ? std::sqrt(off / size) : 0;
}

double run_time_of(const std::vector<double>& seconds, double tick) {
  return std::accumulate(seconds.begin(), seconds.end(), 0.0) / (double(seconds.size()) * tick);
}

std::string percent(double share) { return output::short_number(100 * share, 2) + " %"; }

bool feels(const BenchRun& run) {
  return std::any_of(run.force.begin(), run.force.end(), [](Vec3 force) { return norm(force) > 0; });
}

std::optional<std::size_t> first_growth(const std::vector<double>& errors, double gap) {
  constexpr double kGrowth = 1.2;
  for (std::size_t i = 1; i < errors.size(); ++i)
    if (errors[i] > std::max(kGrowth * errors[i - 1], 2 * gap)) return i;
  return std::nullopt;
}

std::vector<std::size_t> pareto_front(const std::vector<double>& cost, const std::vector<double>& error) {
  std::vector<std::size_t> order(cost.size()), front;
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cost[a] != cost[b] ? cost[a] < cost[b] : error[a] < error[b];
  });
  double least = INFINITY;
  for (const std::size_t i : order)
    if (error[i] < least) least = error[i], front.push_back(i);
  return front;
}

reports::Table bench_layout() {
  reports::Table table;
  table.columns = {{"study", "study"},
                   {"scene", "scene"},
                   {"model", "model"},
                   {"integrator", "integrator"},
                   {"substeps", "substeps"},
                   {"tolerance", "tolerance", 2},
                   {"radius_mm", "r [mm]", 3},
                   {"layers", "layers"},
                   {"spheres", "spheres"},
                   {"position_error", "error in position", 3},
                   {"force_error", "error in force", 3},
                   {"run_time_s_per_s", "processor time [s per s]", 3},
                   {"tick_p50_ms", "tick p50 [ms]", 3},
                   {"tick_p99_ms", "p99 [ms]", 3},
                   {"tick_p999_ms", "p99.9 [ms]", 3},
                   {"unconverged_ticks", "ticks not converged"},
                   {"fallback_ticks", "ticks by backward Euler instead"},
                   {"front", "Pareto front"},
                   {"sleep_below_mm_per_s", "sleep_below_mm_per_s", 3},
                   {"asleep", "share of spheres that sleep", 3}};
  return table;
}

}  // namespace ctpm::bench
