#include "core/stepping/step.h"

#include <cmath>
#include <utility>

#include "core/stepping/workspace.h"

namespace ctpm {
namespace {

/// Settling ends when no sphere is faster than this [m/s].
constexpr double kAtRest = 1e-5;

bool is_usable(const Model& model, const Inputs& inputs) {
  if (inputs.tool < -1 || inputs.tool >= std::int32_t(model.tools.size())) return false;
  const Quat q = inputs.world_from_tool;
  const double length_squared = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return inputs.tool == -1 || (is_finite(inputs.position) && std::abs(length_squared - 1) < 1e-3);
}

}  // namespace

/// A scalpel's way in this tick, and what it severs of the tissue as it rests.
void Stepper::Workspace::sweep(State& state, const Inputs& last, const Inputs& inputs, Grip& grip, StepReport& report) {
  crossings.clear();
  grip.blade.from = blade_edge(*grip.tool, last), grip.blade.to = blade_edge(*grip.tool, inputs);
  if (!state.blade_trail.x.empty()) {
    if (state.last_inputs.tool != inputs.tool)
      state.blade_trail.set(0, grip.blade.to.tip), state.blade_trail.set(1, grip.blade.to.heel);
    tow(*grip.tool, state.blade_trail, grip.blade);
  }
  near->find(state.position, blade.around(*grip.tool, grip.blade));
  report.severed = sever_swept_by_blade(model, *near, grip.blade.from, grip.blade.to, state.position, state, crossings);
  grip.swept = crossings.size();
}

/// What the hand feels after the last substep.
void Stepper::Workspace::report_tool(const State& state, StepReport& report) const {
  if (pinned >= 0) {
    const auto i = std::size_t(pinned);
    report.depth = norm(state.position[i] - model.rest_position[i]);
    report.contacts = 1;
    return;
  }
  report.depth = contact.depth(state);
  report.contacts = contact.count() + pairs.tool_count();
}

Stepper::Stepper(const Model& model, const StepperOptions& options)
    : model_(model), work_(std::make_unique<Workspace>(model, options)) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;

const IntegratorChoice& Stepper::integrator() const { return work_->choice; }

StepReport Stepper::step(State& state, const Inputs& inputs) {
  Workspace& work = *work_;
  StepReport report;
  if (!is_usable(model_, inputs)) report.status = StepStatus::bad_input;
  if (!work.choice.holds) report.status = StepStatus::too_long;
  if (report.status != StepStatus::ok) return report;
  // A tool that was not in the hand before has no way behind it.
  const Inputs last = inputs.tool >= 0 && state.last_inputs.tool == inputs.tool ? state.last_inputs : inputs;
  Grip grip;
  grip.tool = inputs.tool >= 0 ? &model_.tools[std::size_t(inputs.tool)] : nullptr;
  grip.from = last.position, grip.to = inputs.position;
  const bool cuts = grip.is(ToolKind::scalpel);
  // One uncut step is checked before State changes; all others may have to be taken back.
  const bool keeps_backup = cuts || work.choice.integrator == Integrator::sdirk2 || work.choice.substeps > 1;
  if (keeps_backup) work.backup = state;
  if (cuts) work.sweep(state, last, inputs, grip, report);
  work.held_axes = model_.held_axes;
  work.pinned = grip.is(ToolKind::pin) ? grip.tool->sphere : -1;
  if (work.pinned >= 0) work.held_axes[std::size_t(work.pinned)] = kAnchored;

  const std::int32_t substeps = work.choice.substeps;
  const double h = model_.tick / substeps;
  for (std::int32_t k = 1; k <= substeps; ++k) {
    const double share = double(k) / substeps, time = (double(state.tick) + share) * model_.tick;
    if (cuts) work.before = state.position;
    if (!work.advance(state, grip, {h, time, share}, report)) {
      if (keeps_backup) std::swap(state, work.backup);
      return report;
    }
    if (!cuts) continue;
    work.near->follow(state.position);
    report.severed += sever_moved_through_blade(model_, *work.near, grip.blade.to, work.before, state.position, state,
                                                work.crossings);
  }
  work.report_tool(state, report);
  if (report.severed > 0) (void)work.pieces.find(state), report.came_loose = work.pieces.rejoin(work.crossings);
  state.last_inputs = inputs;
  ++state.tick;
  return report;
}

StepReport Stepper::settle(State& state, std::int64_t ticks) {
  const std::int64_t start = state.tick;
  StepReport report;
  work_->has_loads = false;
  for (std::int64_t i = 0; i < ticks; ++i) {
    report = step(state, Inputs{});
    if (is_refused(report.status)) break;
    const Vec3 fastest = state.velocity[std::size_t(report.worst_sphere)];
    if (norm(fastest) < kAtRest) break;
  }
  state.tick = start;
  work_->has_loads = true;
  return report;
}

}  // namespace ctpm
