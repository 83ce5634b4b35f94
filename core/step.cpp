#include "core/step.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/backward_euler.h"
#include "core/blade_force.h"
#include "core/contact.h"
#include "core/cutting.h"
#include "core/elements.h"
#include "core/lips.h"
#include "core/only_springs.h"
#include "core/near_elements.h"
#include "core/outside.h"
#include "core/pair_contact.h"
#include "core/pieces.h"
#include "core/symplectic_euler.h"

namespace ctpm {
namespace {

/// A sphere faster than this [m/s] has left every physical range; the step is refused.
constexpr double kFastest = 1e4;

/// Settling ends when no sphere is faster than this [m/s].
constexpr double kAtRest = 1e-5;

bool is_usable(const Model& model, const Inputs& inputs) {
  if (inputs.tool < -1 || inputs.tool >= std::int32_t(model.tools.size())) return false;
  const Quat q = inputs.world_from_tool;
  const double length_squared = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return inputs.tool == -1 || (is_finite(inputs.position) && std::abs(length_squared - 1) < 1e-3);
}

/// Two approximations of a velocity that differ by more than this share are not yet near their limit: extrapolated they
/// would go beyond it, and gain energy.
constexpr double kFarApart = 0.1;

/// Whether the kinetic energy of the difference of two velocities is small against that of the second.
bool are_close(const Model& model, const Vec3Array& sooner, const Vec3Array& later) {
  double apart = 0, moving = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 v = later[i], difference = v - sooner[i];
    apart += model.mass[i] * dot(difference, difference), moving += model.mass[i] * dot(v, v);
  }
  return apart <= kFarApart * kFarApart * moving;
}

/// later + (later - sooner): the limit of two approximations, the second with half the first one's error.
void extrapolate(const std::vector<double>& sooner, std::vector<double>& later) {
  for (std::size_t i = 0; i < later.size(); ++i) later[i] += later[i] - sooner[i];
}

}  // namespace

/// What the tool in the hand is in one tick.
struct Grip {
  const Tool* tool = nullptr;  ///< null: the hand is empty
  Vec3 from, to;               ///< way of the tool's origin in this tick [m]
  BladeMotion blade;           ///< of a scalpel
  std::size_t swept = 0;       ///< elements that a scalpel severed on its way

  bool is(ToolKind kind) const { return tool != nullptr && tool->kind == kind; }
};

/// Kernels and scratch of one Model.
struct Stepper::Workspace {
  Workspace(const Model& m, const StepperOptions& options)
      : model(m),
        choice(choose_integrator(m)),
        kernels(kernels_for(options.instruction_set)),
        team(options.threads),
        elements(m, team, options.instruction_set),
        contact(m, kernels),
        blade(m),
        lips(m),
        pairs(m, m.has_scalpel() ? blade.most() + lips.most() : 0),
        pieces(m),
        held_axes(m.held_axes),
        velocity(3 * m.sphere_count()) {
    if (m.has_scalpel()) near.emplace(m), crossings.reserve(m.edges.size() + m.tpms.size()), pieces.reserve();
    if (choice.integrator == Integrator::symplectic_euler)
      explicit_solver.emplace(m, elements.slabs());
    else
      implicit_solver.emplace(m, elements.slabs(), team, kernels);
  }

  void sweep(State& state, const Inputs& last, const Inputs& inputs, Grip& grip, StepReport& report);
  void find_pairs(const State& state, const Grip& grip);
  bool advance(State& state, const Grip& grip, double h, double share, double time, StepReport& report);
  bool advance_extrapolated(State& state, const Grip& grip, double h, double share, double time,
                            StepReport& report);
  bool check(StepReport& report);
  void move(State& state, double h);
  void report_tool(const State& state, StepReport& report) const;

  const Model& model;
  IntegratorChoice choice;
  const Kernels& kernels;
  Team team;
  Elements elements;
  BallContact contact;
  BladeForce blade;
  LipContact lips;
  PairContacts pairs;  ///< of the blade and of the lips of cuts
  Pieces pieces;
  std::optional<NearElements> near;  ///< the blade, if the Model has one
  std::vector<Crossing> crossings;  ///< elements severed in this tick
  std::optional<SymplecticEuler> explicit_solver;
  std::optional<BackwardEuler> implicit_solver;
  std::vector<std::uint8_t> held_axes;
  std::int32_t pinned = -1;
  bool has_loads = true;
  Coordinates velocity;
  std::vector<double> fastest_of_slab;  ///< squared speed [m^2/s^2] (slab_count)
  Vec3Array before;  ///< positions before the substep, for what moves through a blade
  State backup;      ///< State before the tick, in case it has to be refused
  State coarse;      ///< of the extrapolation: after one whole step
};

/// Refuses velocities that no tissue has; names the fastest sphere.
bool Stepper::Workspace::check(StepReport& report) {
  const std::size_t n = model.sphere_count();
  const Slabs& slabs = elements.slabs();
  fastest_of_slab.resize(std::size_t(slabs.count()));
  team.for_each(slabs.count(), [&](int slab) {
    fastest_of_slab[std::size_t(slab)] = kernels.fastest_squared(
        n, velocity.data(), std::size_t(slabs.begin(slab)), std::size_t(slabs.end(slab)));
  });
  const auto fastest = std::max_element(fastest_of_slab.begin(), fastest_of_slab.end());
  const auto slab = int(fastest - fastest_of_slab.begin());
  report.worst_sphere = slabs.begin(slab);
  for (std::int32_t sphere = slabs.begin(slab); sphere < slabs.end(slab); ++sphere) {
    const auto i = std::size_t(sphere);
    const double squared = velocity[i] * velocity[i] + velocity[n + i] * velocity[n + i] +
                           velocity[2 * n + i] * velocity[2 * n + i];
    if (squared < *fastest) continue;  // not so if it is not a number
    report.worst_sphere = sphere;
    break;
  }
  if (*fastest <= kFastest * kFastest) return true;
  report.status = StepStatus::diverged;
  return false;
}

void Stepper::Workspace::move(State& state, double h) {
  const std::size_t n = model.sphere_count();
  std::vector<double>* position[3] = {&state.position.x, &state.position.y, &state.position.z};
  std::vector<double>* speed[3] = {&state.velocity.x, &state.velocity.y, &state.velocity.z};
  const Slabs& slabs = elements.slabs();
  team.for_each(slabs.count(), [&](int slab) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double* __restrict p = position[axis]->data(), * __restrict v = speed[axis]->data();
      const double* __restrict next = &velocity[axis * n];
      for (auto i = std::size_t(slabs.begin(slab)); i < std::size_t(slabs.end(slab)); ++i)
        v[i] = next[i], p[i] += h * next[i];
    }
  });
  elements.advance_kelvin(h, state);
}

/// A scalpel's way in this tick, and what it severs of the tissue as it rests.
void Stepper::Workspace::sweep(State& state, const Inputs& last, const Inputs& inputs, Grip& grip,
                               StepReport& report) {
  crossings.clear();
  grip.blade.from = blade_edge(*grip.tool, last), grip.blade.to = blade_edge(*grip.tool, inputs);
  if (!state.blade_trail.x.empty()) {
    if (state.last_inputs.tool != inputs.tool)
      state.blade_trail.set(0, grip.blade.to.tip), state.blade_trail.set(1, grip.blade.to.heel);
    tow(state.blade_trail, grip.blade);
  }
  near->find(state.position, blade.around(grip.blade));
  report.severed =
      sever_swept_by_blade(model, *near, grip.blade.from, grip.blade.to, state.position, state, crossings);
  grip.swept = crossings.size();
}

/// What a scalpel meets, and lips that meet again.
void Stepper::Workspace::find_pairs(const State& state, const Grip& grip) {
  if constexpr (kOnlySprings) return;
  pairs.clear();
  if (grip.is(ToolKind::scalpel) && blade.any()) {
    near->follow(state.position);
    blade.find(state, *near, grip.blade, pairs);
    blade.add_severed(state, grip.blade, std::span(crossings).first(grip.swept), pairs);
  }
  if (lips.is_wanted()) lips.find(state, pairs);
}

/// One first-order step of `h` [s] that ends at `time` [s], with the hand at `share` of its way. False: it must
/// be refused.
bool Stepper::Workspace::advance(State& state, const Grip& grip, double h, double share, double time,
                                 StepReport& report) {
  const Vec3 hand = grip.from + share * (grip.to - grip.from);
  contact.clear();
  find_pairs(state, grip);
  Outside outside{h, time, has_loads, contact, pairs, held_axes, pinned, {}};
  if (pinned >= 0) outside.pin_velocity = (hand - state.position[std::size_t(pinned)]) / h;
  if (!kOnlySprings && grip.is(ToolKind::ball))
    contact.find(state, hand, grip.tool->radius, (grip.to - grip.from) / model.tick);
  if (explicit_solver)
    explicit_solver->solve(elements, state, outside, velocity);
  else
    implicit_solver->solve(elements, state, outside, velocity, report);
  report.tool_force = contact.force_on_tool(h, velocity) + pairs.force_on_tool(h, velocity);
  if (pinned >= 0)
    report.tool_force = explicit_solver
                            ? explicit_solver->force_on_pin(state, outside)
                            : implicit_solver->force_on_pin(elements, state, outside, velocity);
  if (!check(report)) return false;
  move(state, h);
  return true;
}

/// As above, second order: one step of `h` and two of half of it have an error of h and of h/2; their
/// extrapolation to 0 has none of first order (Deuflhard, "Recent progress in extrapolation methods", 1985). Where the two
/// are far apart, the second one is kept as it is.
bool Stepper::Workspace::advance_extrapolated(State& state, const Grip& grip, double h, double share, double time,
                                              StepReport& report) {
  const double half = 0.5 * h, half_share = 0.5 * h / model.tick;
  coarse = state;
  if (!advance(coarse, grip, h, share, time, report)) return false;
  const Vec3 coarse_force = report.tool_force;
  if (!advance(state, grip, half, share - half_share, time - half, report)) return false;
  if (!advance(state, grip, half, share, time, report)) return false;
  if (!are_close(model, coarse.velocity, state.velocity)) return true;
  extrapolate(coarse.position.x, state.position.x), extrapolate(coarse.velocity.x, state.velocity.x);
  extrapolate(coarse.position.y, state.position.y), extrapolate(coarse.velocity.y, state.velocity.y);
  extrapolate(coarse.position.z, state.position.z), extrapolate(coarse.velocity.z, state.velocity.z);
  extrapolate(coarse.kelvin_elongation, state.kelvin_elongation);
  report.tool_force += report.tool_force - coarse_force;
  return true;
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
  const bool extrapolates = work.choice.integrator == Integrator::extrapolated_euler;
  // One uncut step is checked before State changes; all others may have to be taken back.
  const bool keeps_backup = cuts || extrapolates || work.choice.substeps > 1;
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
    const bool done = extrapolates
                          ? work.advance_extrapolated(state, grip, h, share, time, report)
                          : work.advance(state, grip, h, share, time, report);
    if (!done) {
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
