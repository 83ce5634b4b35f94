#include "core/stepping/step.h"

#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "core/contact/contacts.h"
#include "core/inversion/resistance.h"
#include "core/stepping/backward_euler.h"
#include "core/stepping/blade_sweep.h"
#include "core/stepping/implicit_solve.h"
#include "core/stepping/leapfrog.h"
#include "core/stepping/motion.h"
#include "core/stepping/sdirk2.h"
#include "core/stepping/substep.h"

namespace ctpm::stepping {
namespace {

/// Settling ends when no sphere is faster than this [m/s].
constexpr double kAtRest = 1e-5;

bool is_usable(const Model& model, const Inputs& inputs) {
  if (inputs.tool < -1 || inputs.tool >= std::int32_t(model.tools.size())) return false;
  const Quat q = inputs.world_from_tool;
  const double length_squared = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return inputs.tool == -1 || (is_finite(inputs.position) && std::abs(length_squared - 1) < 1e-3);
}

/// One type of integrator, constructed in place.
using AnyIntegrator = std::variant<std::monostate, Leapfrog, BackwardEuler, Sdirk2>;

}  // namespace

/// Kernels, integrator and scratch memory of one Model.
struct Stepper::Parts {
  Parts(const Model& m, const StepperOptions& options)
      : model(m),
        choice(check_integrator(m)),
        kernels(elements::kernels_for(options.instruction_set)),
        team(options.threads),
        elements(m, team, options.instruction_set),
        contacts(m, kernels),
        resistance(m, elements.slabs(), team, kernels),
        next(m) {
    if (m.has_scalpel()) blade.emplace(m);
    contacts.reserve(next.touched);
    reserve(trial);
    if (choice.integrator == Integrator::leapfrog) {
      integrator.emplace<Leapfrog>(context);
      return;
    }
    implicit_solve.emplace(context);
    if (choice.integrator == Integrator::sdirk2)
      integrator.emplace<Sdirk2>(context, *implicit_solve);
    else
      integrator.emplace<BackwardEuler>(context, *implicit_solve);
  }

  contact::HeldTool hold(const Inputs& last, const Inputs& inputs) const;
  bool advance(const State& from, const contact::HeldTool& tool, const Substep& part, StepReport& report);
  bool run_substeps(State& state, const contact::HeldTool& tool, StepReport& report);
  void reserve(State& state) const;

  const Model& model;
  IntegratorChoice choice;
  const elements::Kernels& kernels;
  parallel::Team team;
  elements::Elements elements;
  contact::Contacts contacts;
  inversion::Resistance resistance;
  StepContext context{model, kernels, team, elements, contacts, resistance};
  std::optional<ImplicitSolve> implicit_solve;  ///< empty for leapfrog
  AnyIntegrator integrator;
  std::optional<BladeSweep> blade;  ///< empty if the Model has no scalpel
  Motion next;                      ///< result of a substep
  /// Trial state of a tick that changes State more than once.
  State trial;
  bool has_loads = true;
};

contact::HeldTool Stepper::Parts::hold(const Inputs& last, const Inputs& inputs) const {
  contact::HeldTool tool;
  tool.tool = inputs.tool >= 0 ? &model.tools[std::size_t(inputs.tool)] : nullptr;
  tool.from = last.position, tool.to = inputs.position;
  return tool;
}

/// Reserves memory for what a ball can touch.
void Stepper::Parts::reserve(State& state) const {
  contact::Touched touched{std::move(state.touched), std::move(state.grip), std::move(state.kelvin_dent)};
  contacts.reserve(touched);
  if (model.has_scalpel()) {
    const std::size_t points = cutting::kMostSweptRows * kEdgeNodes;
    for (auto* axis : {&state.swept.x, &state.swept.y, &state.swept.z}) axis->reserve(points);
    state.swept_organ.reserve(points);
  }
  state.touched = std::move(touched.point), state.grip = std::move(touched.grip),
  state.kelvin_dent = std::move(touched.kelvin_dent);
}

/// One substep into `next`. False: it is refused.
bool Stepper::Parts::advance(const State& from, const contact::HeldTool& tool, const Substep& part,
                             StepReport& report) {
  return std::visit(
      [&]<class Method>(Method& method) {
        if constexpr (std::is_same_v<Method, std::monostate>)
          return false;
        else
          return method.step(from, tool, part, next, report);
      },
      integrator);
}

/// All substeps of a tick. False: one was refused, and `state` is as before that one.
bool Stepper::Parts::run_substeps(State& state, const contact::HeldTool& tool, StepReport& report) {
  const std::int32_t substeps = choice.substeps;
  const double h = model.tick / substeps;
  for (std::int32_t k = 1; k <= substeps; ++k) {
    const double share = double(k) / substeps, time = (double(state.tick) + share) * model.tick;
    const bool cuts = tool.is(ToolKind::scalpel);
    if (cuts) blade->begin_substep(state);
    if (!advance(state, tool, {h, time, share, has_loads}, report)) return false;
    commit(next, state);
    if (cuts) blade->end_substep(tool, share, state, report);
  }
  return true;
}

Stepper::Stepper(const Model& model, const StepperOptions& options)
    : model_(model), parts_(std::make_unique<Parts>(model, options)) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;

const IntegratorChoice& Stepper::integrator() const { return parts_->choice; }

void Stepper::prepare() {
  if (model_.has_scalpel()) parts_->contacts.prepare();
}

StepReport Stepper::step(State& state, const Inputs& inputs) {
  Parts& parts = *parts_;
  StepReport report;
  if (!is_usable(model_, inputs)) report.status = StepStatus::bad_input;
  if (!parts.choice.holds) report.status = StepStatus::too_long;
  if (report.status != StepStatus::ok) return report;
  // A tool that has just been picked up has not moved yet.
  const Inputs last = inputs.tool >= 0 && state.last_inputs.tool == inputs.tool ? state.last_inputs : inputs;
  contact::HeldTool tool = parts.hold(last, inputs);
  const bool cuts = tool.is(ToolKind::scalpel);
  parts.reserve(state);
  // An integrator leaves State unchanged until its substep is committed. Ticks that change State more than once work on
  // the trial state.
  const bool changes_once = !cuts && parts.choice.substeps == 1;
  if (!changes_once) parts.trial = state;
  State& current = changes_once ? state : parts.trial;
  parts.contacts.begin_tick(current, cuts);
  if (cuts) parts.blade->begin_tick(last, inputs, tool, current);
  if (!parts.run_substeps(current, tool, report)) {
    // Nothing of a refused tick has happened.
    StepReport refused;
    refused.status = report.status, refused.worst_sphere = report.worst_sphere;
    refused.residual = report.residual, refused.iterations = report.iterations;
    return refused;
  }
  if (cuts) parts.blade->report_pieces(current, report);
  report.inverted = parts.resistance.count_inverted(current);
  if (!changes_once) std::swap(state, parts.trial);
  state.last_inputs = inputs;
  ++state.tick;
  return report;
}

StepReport Stepper::settle(State& state, std::int64_t ticks) {
  const std::int64_t start = state.tick;
  StepReport report;
  parts_->has_loads = false;
  for (std::int64_t i = 0; i < ticks; ++i) {
    report = step(state, Inputs{});
    if (is_refused(report.status)) break;
    const Vec3 fastest = state.velocity[std::size_t(report.worst_sphere)];
    if (norm(fastest) < kAtRest) break;
  }
  state.tick = start;
  parts_->has_loads = true;
  return report;
}

}  // namespace ctpm::stepping
