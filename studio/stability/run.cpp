// Runs one case under one integrator and checks it tick by tick; runs all cases in parallel.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include "core/elements/forces.h"
#include "core/stepping/step.h"
#include "recordings/state_hash.h"
#include "studio/output/number_text.h"
#include "studio/stability/stability.h"

namespace ctpm::stability {
namespace {

/// Samples of a run: enough to resolve every oscillation of a case of a thousand ticks.
constexpr std::int64_t kSamples = 2000;

/// Energy may grow by this share of kinetic plus elastic energy, because solvers stop at a residual.
constexpr double kEnergySlack = 1e-4;

struct Energy {
  double motion = 0, stored = 0;  ///< kinetic; elastic, of springs and two-sphere TPMs [J], >= 0
  double lift = 0;                ///< gravitational, relative to the rest positions [J]
  double total() const { return motion + stored + lift; }
};

Energy energy_of(const Model& model, const State& state) {
  Energy energy;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 v = state.velocity[i];
    energy.motion += 0.5 * model.mass[i] * dot(v, v);
    energy.lift -= model.mass[i] * dot(model.gravity, state.position[i] - model.rest_position[i]);
  }
  energy.stored = elements::elastic_energy(model, state);
  return energy;
}

struct Extent {
  double distance = 0;  ///< of the furthest sphere from its rest position [m]; infinite if not a number
  double speed = 0;     ///< of the fastest [m/s]; infinite if not a number
};

Extent extent_of(const Model& model, const State& state) {
  Extent extent;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 way = state.position[i] - model.rest_position[i], v = state.velocity[i];
    if (!is_finite(way) || !is_finite(v)) return {INFINITY, INFINITY};
    extent.distance = std::max(extent.distance, norm(way)), extent.speed = std::max(extent.speed, norm(v));
  }
  return extent;
}

const char* to_words(stepping::StepStatus status) {
  switch (status) {
    case stepping::StepStatus::ok:
      return "ok";
    case stepping::StepStatus::not_converged:
      return "the solve did not converge";
    case stepping::StepStatus::bad_input:
      return "bad input";
    case stepping::StepStatus::diverged:
      return "diverged";
    case stepping::StepStatus::too_long:
      return "the step is too long";
  }
  return "";
}

/// Checks a run's energy from the tick on at which external work ends; see run_stability_case().
class EnergyWatch {
 public:
  EnergyWatch(const Model& model, const stepping::IntegratorChoice& choice, double middle)
      : middle_(middle),
        is_explicit_(choice.integrator == Integrator::leapfrog),
        has_softening_(model.has_softening),
        has_constraints_(model.constraints.size() > 0) {
    const double share = model.tick / choice.substeps / stepping::stable_step_bound(model);
    if (is_explicit_ && choice.holds) swing_ = 1 / (1 - share * share);
  }

  /// The violation at this sample; empty if there is none.
  std::string take(const Energy& energy, double time) {
    // Softened springs return less than their energy function says, so only kinetic and gravitational energy count.
    const double now = has_softening_ ? energy.motion + energy.lift : energy.total();
    if (!has_begun_) has_begun_ = true, limit_ = energy.total();
    scale_ = std::max(scale_, energy.motion + energy.stored);
    sum_[time > middle_] += energy.total(), ++count_[time > middle_];
    if (now > limit_ + (swing_ - 1 + kEnergySlack) * scale_ + 1e-15)
      return "energy grew from " + output::short_number(limit_) + " J to " + output::short_number(now) + " J";
    if (!is_explicit_ && !has_softening_ && !has_constraints_) limit_ = std::min(limit_, now);
    return "";
  }

  /// The violation of the whole run; empty if there is none.
  std::string finish() const {
    if (!is_explicit_ || count_[0] == 0 || count_[1] == 0) return "";
    const double first = sum_[0] / count_[0], second = sum_[1] / count_[1];
    if (second <= first + 0.05 * scale_) return "";
    return "mean energy rose from " + output::short_number(first) + " J to " + output::short_number(second) + " J";
  }

 private:
  double middle_, limit_ = 0, scale_ = 0, swing_ = 1;
  bool is_explicit_, has_softening_, has_constraints_, has_begun_ = false;
  double sum_[2] = {0, 0};
  int count_[2] = {0, 0};
};

/// Checks a run while it is simulated.
struct Watch {
  Watch(const StabilityCase& c, const Model& m, const stepping::IntegratorChoice& choice)
      : what(c), model(m), energy(m, choice, 0.5 * double(c.ticks + c.free_from) * m.tick) {}

  /// The violation after tick `tick`; empty if there is none.
  std::string sample(const State& state, std::int64_t tick, StabilityRun& run) {
    const Extent extent = extent_of(model, state);
    const double time = double(tick) * model.tick;
    run.reach = std::max(run.reach, extent.distance), run.end_speed = extent.speed;
    run.distance.x.push_back(time), run.distance.y.push_back(1e3 * extent.distance);
    if (std::isinf(extent.distance)) return "a position or velocity is not finite";
    const Energy now = energy_of(model, state);
    run.energy.x.push_back(time), run.energy.y.push_back(now.total());
    if (extent.distance > what.reach)
      return "a sphere is " + output::short_number(1e3 * extent.distance) + " mm from its rest position, more than " +
             output::short_number(1e3 * what.reach) + " mm";
    const std::string grown = what.free_from >= 0 && tick >= what.free_from ? energy.take(now, time) : "";
    is_undamped = !grown.empty();
    return grown;
  }

  std::string finish(const State& first, const State& last) {
    if (std::string wrong = energy.finish(); !wrong.empty()) return wrong;
    const Extent extent = extent_of(model, last);
    is_undamped = extent.speed > what.end_speed;
    if (is_undamped) return "does not come to rest: " + output::short_number(1e3 * extent.speed) + " mm/s at the end";
    if (extent.distance > what.end_distance)
      return "ends " + output::short_number(1e3 * extent.distance) + " mm from where it should rest";
    return what.also ? what.also(model, first, last) : "";
  }

  const StabilityCase& what;
  const Model& model;
  EnergyWatch energy;
  bool is_undamped = false;  ///< the violation is growing energy or persistent motion
};

std::string at_tick(std::int64_t tick, double length) {
  return "tick " + std::to_string(tick) + " (" + output::short_number(double(tick) * length) + " s)";
}

}  // namespace

StabilityRun run_stability_case(const StabilityCase& what, std::optional<Integrator> integrator) {
  StabilityRun run;
  Model model = what.build();
  run.asked = integrator;
  const stepping::IntegratorChoice choice = stepping::resolve_integrator(model, integrator);
  stepping::Stepper stepper(model);
  run.used = choice.integrator, run.substeps = choice.substeps;
  State state = rest_state(model);
  if (what.disturb) what.disturb(model, state);
  const State first = state;
  Watch watch(what, model, choice);
  const std::int64_t every = std::max<std::int64_t>(1, what.ticks / kSamples);
  run.reason = watch.sample(state, 0, run);
  for (std::int64_t tick = 0; tick < what.ticks && run.reason.empty(); ++tick) {
    const std::uint64_t before = recordings::state_hash(state);
    const stepping::StepReport report = stepper.step(state, what.hand ? what.hand(tick) : Inputs{});
    if (!is_finite(report.tool_force)) run.reason = at_tick(tick, model.tick) + ": the force is not finite";
    const bool is_refused =
        report.status != stepping::StepStatus::ok && report.status != stepping::StepStatus::not_converged;
    const bool is_bad_input = what.is_bad_input && what.is_bad_input(tick);
    if (is_refused && recordings::state_hash(state) != before)
      run.reason = at_tick(tick, model.tick) + ": refused, but the State changed";
    else if (is_bad_input && report.status == stepping::StepStatus::bad_input)
      continue;
    else if (is_refused) {
      run.reason = at_tick(tick, model.tick) + ": " + to_words(report.status);
      if (report.status == stepping::StepStatus::too_long) run.reason = choice.reason;
      if (integrator) run.verdict = reports::ReportVerdict::refused;
    } else if (is_bad_input) {
      run.reason = at_tick(tick, model.tick) + ": input that no hand gives was taken";
    } else {
      ++run.ticks, run.unconverged += report.status == stepping::StepStatus::not_converged;
      run.fallbacks += report.fallbacks > 0;
      if ((tick + 1) % every == 0 || tick + 1 == what.ticks) {
        const std::string wrong = watch.sample(state, tick + 1, run);
        if (!wrong.empty()) run.reason = at_tick(tick + 1, model.tick) + ": " + wrong;
      }
    }
  }
  if (run.reason.empty()) run.reason = watch.finish(first, state);
  if (run.reason.empty()) run.verdict = reports::ReportVerdict::met;
  if (watch.is_undamped && !choice.damps) run.reason += " (" + choice.reason + ")";
  return run;
}

std::vector<StabilityRow> run_stability(const std::vector<StabilityCase>& cases, std::size_t integrators,
                                        const std::function<void(std::int64_t done, std::int64_t total)>& progress) {
  std::vector<StabilityRow> rows;
  for (const StabilityCase& what : cases) rows.push_back({&what, std::vector<StabilityRun>(integrators)});
  const std::size_t total = integrators * cases.size();
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::int64_t done = 0;
  const auto work = [&] {
    for (std::size_t job = next++; job < total; job = next++) {
      const std::size_t of = job / integrators, under = job % integrators;
      rows[of].runs[under] = run_stability_case(cases[of], kStabilityIntegrators[under]);
      const std::lock_guard<std::mutex> lock(mutex);
      progress(++done, std::int64_t(total));
    }
  };
  std::vector<std::thread> workers;
  for (unsigned i = 1; i < std::max(1u, std::thread::hardware_concurrency()); ++i) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  return rows;
}

std::int64_t count_failures(const std::vector<StabilityRow>& rows) {
  return std::count_if(rows.begin(), rows.end(),
                       [](const StabilityRow& row) { return row.runs[0].verdict != reports::ReportVerdict::met; });
}

}  // namespace ctpm::stability
