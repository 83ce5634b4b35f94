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

bool is_usable(const Model& model, const Hand& hand) {
  if (hand.tool < -1 || hand.tool >= std::int32_t(model.tools.size())) return false;
  const Quat q = hand.world_from_tool;
  const double length_squared = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return hand.tool == -1 || (is_finite(hand.position) && std::abs(length_squared - 1) < 1e-3);
}

bool is_usable(const Model& model, const Inputs& inputs) {
  if (!is_usable(model, inputs.hand(0))) return false;
  if (inputs.second == Hand{}) return true;
  return model.hands > 1 && is_usable(model, inputs.second) &&
         hands_conflict(model, inputs.tool, inputs.second.tool).empty();
}

/// What a hand did in the tick before; one that has just picked up its tool has not moved yet.
const Hand& last_of(const State& state, const Inputs& inputs, std::size_t hand) {
  const Hand &before = state.last_inputs.hand(hand), &now = inputs.hand(hand);
  return now.tool >= 0 && before.tool == now.tool ? before : now;
}

/// One type of integrator, constructed in place.
using AnyIntegrator = std::variant<std::monostate, Leapfrog, BackwardEuler, Sdirk2>;

}  // namespace

std::string_view hands_conflict(const Model& model, std::int32_t first, std::int32_t second) {
  if (first < 0 || second < 0) return {};
  if (first == second) return "both hands hold the same tool";
  const Tool &a = model.tools[std::size_t(first)], &b = model.tools[std::size_t(second)];
  if (a.kind != b.kind) return {};
  if (a.kind == ToolKind::scalpel) return "both hands hold a scalpel, and one blade cuts at a time";
  if (a.kind == ToolKind::pin && a.sphere == b.sphere) return "the pins in both hands hold the same sphere";
  return {};
}

/// Kernels, integrator and scratch memory of one Model.
struct Stepper::Parts {
  Parts(const Model& m, const StepperOptions& options)
      : model(m),
        choice(check_integrator(m)),
        kernels(elements::kernels_for(options.instruction_set)),
        team(options.threads),
        elements(m, team, options.instruction_set),
        contacts(m, kernels, options.watch),
        resistance(m, elements.slabs(), team, kernels),
        next(m),
        watch(options.watch) {
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

  contact::HeldTool hold(const Hand& last, const Hand& hand) const;
  bool advance(const State& from, const contact::HeldTools& tools, const Substep& part, StepReport& report);
  void begin_cuts(const State& last, const Inputs& inputs, contact::HeldTools& tools, State& state);
  bool run_substeps(State& state, const contact::HeldTools& tools, StepReport& report);
  void reserve(State& state) const;

  const Model& model;
  IntegratorChoice choice;
  const elements::Kernels& kernels;
  parallel::Team team;
  elements::Elements elements;
  contact::Contacts contacts;
  inversion::Resistance resistance;
  Sleepers sleepers{model, elements, team, kernels, contacts};
  StepContext context{model, kernels, team, elements, contacts, resistance, sleepers};
  std::optional<ImplicitSolve> implicit_solve;  ///< empty for leapfrog
  AnyIntegrator integrator;
  std::optional<BladeSweep> blade;  ///< empty if the Model has no scalpel
  Motion next;                      ///< result of a substep
  /// Trial state of a tick that changes State more than once.
  State trial;
  bool has_loads = true;
  StageWatch* watch;  ///< null: nobody measures
};

contact::HeldTool Stepper::Parts::hold(const Hand& last, const Hand& hand) const {
  contact::HeldTool tool;
  tool.tool = hand.tool >= 0 ? &model.tools[std::size_t(hand.tool)] : nullptr;
  tool.from = last.position, tool.to = hand.position;
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
bool Stepper::Parts::advance(const State& from, const contact::HeldTools& tools, const Substep& part,
                             StepReport& report) {
  const StepReport before = report;
  sleepers.begin(from, tools, part);
  for (;;) {
    const bool is_done = std::visit(
        [&]<class Method>(Method& method) {
          if constexpr (std::is_same_v<Method, std::monostate>)
            return false;
          else
            return method.step(from, tools, part, next, report);
        },
        integrator);
    if (is_done) break;
    if (!sleepers.has_woken()) return false;
    sleepers.resume(), report = before;
  }
  sleepers.finish(from, part, next);
  report.asleep = sleepers.count();
  return true;
}

/// Follows what is cut in `state`, with which the tick begins, and the blades from where they were in `last`.
void Stepper::Parts::begin_cuts(const State& last, const Inputs& inputs, contact::HeldTools& tools, State& state) {
  const InStage cutting(watch, Stage::cut);
  contacts.begin_tick(state, contact::held_scalpel(tools) != nullptr);
  for (std::size_t hand = 0; hand < kMostHands; ++hand)
    if (tools[hand].is(ToolKind::scalpel))
      blade->begin_tick(last_of(last, inputs, hand), inputs.hand(hand),
                        last.last_inputs.hand(hand).tool != inputs.hand(hand).tool, tools[hand], state);
}

/// All substeps of a tick. False: one was refused, and `state` is as before that one.
bool Stepper::Parts::run_substeps(State& state, const contact::HeldTools& tools, StepReport& report) {
  const contact::HeldTool* const scalpel = contact::held_scalpel(tools);
  const std::int32_t substeps = choice.substeps;
  const double h = model.tick / substeps;
  for (std::int32_t k = 1; k <= substeps; ++k) {
    const double share = double(k) / substeps, time = (double(state.tick) + share) * model.tick;
    if (scalpel != nullptr) {
      const InStage cutting(watch, Stage::cut);
      blade->begin_substep(state);
    }
    if (!advance(state, tools, {h, time, share, has_loads}, report)) return false;
    commit(elements.slabs(), team, next, state);
    if (scalpel == nullptr) continue;
    const InStage cutting(watch, Stage::cut);
    blade->end_substep(*scalpel, share, state, report);
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
  contact::HeldTools tools;
  for (std::size_t hand = 0; hand < kMostHands; ++hand)
    tools[hand] = parts.hold(last_of(state, inputs, hand), inputs.hand(hand));
  const bool cuts = contact::held_scalpel(tools) != nullptr;
  parts.reserve(state);
  // An integrator leaves State unchanged until its substep is committed. Ticks that change State more than once work on
  // the trial state.
  const bool changes_once = !cuts && parts.choice.substeps == 1 && !parts.contacts.changes(state, cuts);
  if (!changes_once) parts.trial = state;
  State& current = changes_once ? state : parts.trial;
  parts.begin_cuts(state, inputs, tools, current);
  if (!parts.run_substeps(current, tools, report)) {
    // Nothing of a refused tick has happened.
    StepReport refused;
    refused.status = report.status, refused.worst_sphere = report.worst_sphere;
    refused.residual = report.residual, refused.iterations = report.iterations;
    return refused;
  }
  if (cuts) {
    const InStage cutting(parts.watch, Stage::cut);
    parts.blade->report_pieces(current, report);
  }
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
