#include "core/step.h"

#include <algorithm>
#include <cmath>

#include "core/angle_spring.h"
#include "core/axial.h"
#include "core/block_jacobi.h"
#include "core/conjugate_gradient.h"
#include "core/constraint.h"
#include "core/contact.h"
#include "core/cutting.h"
#include "core/result.h"

namespace ctpm {
namespace {

/// A sphere faster than this [m/s] has left every physical range; the step is refused.
constexpr double kFastest = 1e4;

/// Settling ends when no sphere is faster than this [m/s].
constexpr double kAtRest = 1e-5;

/// Rounds in which contacts that would pull are dropped and the step is solved again.
constexpr int kContactRounds = 4;

bool is_usable(const Model& model, const Inputs& inputs) {
  if (inputs.tool < -1 || inputs.tool >= std::int32_t(model.tools.size())) return false;
  const Quat q = inputs.world_from_tool;
  const double length_squared = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return inputs.tool == -1 || (is_finite(inputs.position) && std::abs(length_squared - 1) < 1e-3);
}

}  // namespace

/// Kernels and scratch of one Model. One substep solves
///   (M + h C + h^2 K) v' = M v + h (f_elastic(x) + f_contact(x) + M g),  x' = x + h v',
/// backward Euler linearised once: L-stable, first order, and as stiff a dashpot as one likes.
struct Stepper::Workspace {
  explicit Workspace(const Model& m)
      : model(m),
        axial(m),
        constraints(m),
        angles(m),
        contact(m),
        jacobi(m.sphere_count()),
        solver(3 * m.sphere_count()),
        held_axes(m.held_axes),
        force(3 * m.sphere_count()),
        momentum(3 * m.sphere_count()),
        velocity(3 * m.sphere_count()),
        blocks(6 * m.sphere_count()),
        softness(m.has_softening ? m.sphere_count() : 0),
        before(m.sphere_count()) {
    const double total_mass = fixed_order_dot(m.mass, std::vector<double>(m.mass.size(), 1.0));
    for (std::size_t i = 0; i < m.sphere_count(); ++i)
      if (m.held_axes[i] != 0 && m.held_axes[i] != kAnchored) guided.push_back(std::int32_t(i));
    limits.relative = m.solver.tolerance;
    limits.absolute = m.solver.velocity_floor * std::sqrt(total_mass);
    limits.max_iterations = m.solver.max_iterations;
  }

  void linearise(const State& state, double h);
  void add_loads(double time);
  void apply(const State& state, double h, const Coordinates& in, Coordinates& out) const;
  void solve(const State& state, double h, double time, StepReport& report);
  void uncouple_guided();
  Vec3 force_on_pin(const State& state, double h);
  bool is_held(std::size_t sphere, std::size_t axis) const { return (held_axes[sphere] >> axis & 1) != 0; }
  bool check(StepReport& report) const;
  void advance(State& state, double h);
  struct Grip;
  bool substep(State& state, const Grip& grip, double h, double share, double time, StepReport& report);
  void report_tool(const State& state, double h, StepReport& report) const;

  const Model& model;
  AxialElements axial;
  ConstraintElements constraints;
  AngleElements angles;
  BallContact contact;
  BlockJacobi jacobi;
  ConjugateGradient solver;
  CgLimits limits;
  std::vector<std::uint8_t> held_axes;  ///< of the Model, and of the sphere that a pin holds
  std::vector<std::int32_t> guided;     ///< spheres of which some axes are held and others not
  std::int32_t pinned = -1;
  Vec3 pin_velocity;      ///< that brings the pinned sphere to the hand [m/s]
  bool has_loads = true;  ///< loads act (they do not while the scene settles)
  Coordinates force, momentum, velocity;
  DiagonalBlocks blocks;
  std::vector<double> softness;
  Vec3Array before;  ///< positions before the substep, for what moves through a blade
  State backup;      ///< State before the tick, in case it has to be refused
};

/// Forces and matrix at the State's positions; the dashpots' forces are all in the matrix.
void Stepper::Workspace::linearise(const State& state, double h) {
  const std::size_t n = model.sphere_count();
  const Vec3 gravity = model.gravity;
  for (std::size_t i = 0; i < n; ++i) {
    const double mass = model.mass[i];
    force[i] = mass * gravity.x, force[n + i] = mass * gravity.y, force[2 * n + i] = mass * gravity.z;
    blocks[i] = blocks[3 * n + i] = blocks[5 * n + i] = mass;
    blocks[n + i] = blocks[2 * n + i] = blocks[4 * n + i] = 0;
  }
  if (model.constraints.size() > 0) {
    constraints.measure_tilt(state, softness);
    constraints.linearise(state, softness, h, force, blocks);
  }
  if (model.angle_springs.size() > 0) angles.linearise(state, h, force, blocks);
  axial.linearise(state, softness, h, force, blocks);
}

void Stepper::Workspace::add_loads(double time) {
  const Loads& loads = model.loads;
  const std::size_t n = model.sphere_count();
  for (std::size_t l = 0; l < loads.size(); ++l) {
    const double since = time - loads.start[l];
    const double share = since <= 0 ? 0.0 : (since >= loads.ramp[l] ? 1.0 : since / loads.ramp[l]);
    const Vec3 pull = share * loads.force[l];
    const auto i = std::size_t(loads.sphere[l]);
    force[i] += pull.x, force[n + i] += pull.y, force[2 * n + i] += pull.z;
  }
}

/// Product with the matrix of all spheres, held ones too.
void Stepper::Workspace::apply(const State& state, double h, const Coordinates& in, Coordinates& out) const {
  const std::size_t n = model.sphere_count();
  const double* mass = model.mass.data();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i) out[axis * n + i] = mass[i] * in[axis * n + i];
  axial.apply(in, out);
  if (model.constraints.size() > 0) constraints.apply(in, out);
  if (model.angle_springs.size() > 0) angles.apply(state, h, in, out);
  if (contact.count() > 0) contact.apply(h, in, out);
}

/// Velocity at the end of the substep; contacts only push.
void Stepper::Workspace::solve(const State& state, double h, double time, StepReport& report) {
  const std::size_t n = model.sphere_count();
  const double* old_velocity[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i)
      velocity[axis * n + i] = is_held(i, axis) ? 0.0 : old_velocity[axis][i];
  if (pinned >= 0) {
    const auto i = std::size_t(pinned);
    velocity[i] = pin_velocity.x, velocity[n + i] = pin_velocity.y, velocity[2 * n + i] = pin_velocity.z;
  }
  for (int round = 0;; ++round) {
    linearise(state, h);
    contact.linearise(h, force, blocks);
    if (has_loads && model.loads.size() > 0) add_loads(time);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < n; ++i)
        momentum[axis * n + i] =
            is_held(i, axis) ? 0.0 : model.mass[i] * old_velocity[axis][i] + h * force[axis * n + i];
    uncouple_guided();
    jacobi.factorise(blocks);
    const CgOutcome outcome = solver.solve(
        momentum, velocity, limits,
        [&](const Coordinates& in, Coordinates& out) {
          apply(state, h, in, out);
          for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t i = 0; i < n; ++i)
              out[axis * n + i] = is_held(i, axis) ? 0.0 : out[axis * n + i];
        },
        [&](const Coordinates& in, Coordinates& out) { jacobi.apply(in, out); });
    report.iterations += outcome.iterations;
    report.residual = outcome.residual;
    if (!outcome.converged) report.status = StepStatus::not_converged;
    if (round == kContactRounds || !contact.drop_pulling(h, velocity)) return;
  }
}

/// The preconditioner must not move a guided sphere along a held axis.
void Stepper::Workspace::uncouple_guided() {
  const std::size_t n = model.sphere_count();
  for (const std::int32_t sphere : guided) {
    const auto i = std::size_t(sphere);
    const bool x = is_held(i, 0), y = is_held(i, 1), z = is_held(i, 2);
    if (x || y) blocks[n + i] = 0;
    if (x || z) blocks[2 * n + i] = 0;
    if (y || z) blocks[4 * n + i] = 0;
  }
}

/// What the tissue does to the pin [N]: the pinned sphere's row of the balance of momentum, with the sign
/// turned.
Vec3 Stepper::Workspace::force_on_pin(const State& state, double h) {
  const std::size_t n = model.sphere_count();
  const auto i = std::size_t(pinned);
  apply(state, h, velocity, momentum);
  const Vec3 done{momentum[i], momentum[n + i], momentum[2 * n + i]},
      own{force[i], force[n + i], force[2 * n + i]};
  return (model.mass[i] * state.velocity[i] + h * own - done) / h;
}

/// Refuses velocities that no tissue has; names the fastest sphere.
bool Stepper::Workspace::check(StepReport& report) const {
  const std::size_t n = model.sphere_count();
  double fastest_squared = -1;
  for (std::size_t i = 0; i < n; ++i) {
    const double squared = velocity[i] * velocity[i] + velocity[n + i] * velocity[n + i] +
                           velocity[2 * n + i] * velocity[2 * n + i];
    if (!(squared <= kFastest * kFastest)) {
      report.status = StepStatus::diverged;
      report.worst_sphere = std::int32_t(i);
      return false;
    }
    if (squared > fastest_squared) fastest_squared = squared, report.worst_sphere = std::int32_t(i);
  }
  return true;
}

void Stepper::Workspace::advance(State& state, double h) {
  const std::size_t n = model.sphere_count();
  std::vector<double>* position[3] = {&state.position.x, &state.position.y, &state.position.z};
  std::vector<double>* speed[3] = {&state.velocity.x, &state.velocity.y, &state.velocity.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double* __restrict p = position[axis]->data(), * __restrict v = speed[axis]->data();
    const double* __restrict next = &velocity[axis * n];
    for (std::size_t i = 0; i < n; ++i) v[i] = next[i], p[i] += h * next[i];
  }
  axial.advance_kelvin(state.position, h, state);
}

Stepper::Stepper(const Model& model) : model_(model), work_(std::make_unique<Workspace>(model)) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;

/// What the tool in the hand is in this tick.
struct Stepper::Workspace::Grip {
  const Tool* tool = nullptr;  ///< null: the hand is empty
  Vec3 from, to;               ///< way of the tool's origin in this tick [m]
  BladeEdge blade;             ///< of a scalpel, at the end of the tick

  bool is(ToolKind kind) const { return tool != nullptr && tool->kind == kind; }
};

/// One substep of `h` [s] that ends at `time` [s], with the hand at `share` of its way. False: the step must
/// be refused.
bool Stepper::Workspace::substep(State& state, const Grip& grip, double h, double share, double time,
                                 StepReport& report) {
  const Vec3 hand = grip.from + share * (grip.to - grip.from);
  contact.clear();
  if (pinned >= 0) pin_velocity = (hand - state.position[std::size_t(pinned)]) / h;
  if (grip.is(ToolKind::ball))
    contact.find(state, hand, grip.tool->radius, (grip.to - grip.from) / model.tick);
  solve(state, h, time, report);
  if (pinned >= 0) report.tool_force = force_on_pin(state, h);
  if (!check(report)) return false;
  if (grip.is(ToolKind::scalpel)) before = state.position;
  advance(state, h);
  if (grip.is(ToolKind::scalpel))
    report.severed += sever_moved_through_blade(model, grip.blade, before, state.position, state);
  return true;
}

/// What the hand feels after the last substep of `h` [s].
void Stepper::Workspace::report_tool(const State& state, double h, StepReport& report) const {
  if (pinned >= 0) {
    const auto i = std::size_t(pinned);
    report.depth = norm(state.position[i] - model.rest_position[i]);
    report.contacts = 1;
    return;
  }
  report.tool_force = contact.force_on_tool(h, velocity);
  report.depth = contact.depth(state);
  report.contacts = contact.count();
}

StepReport Stepper::step(State& state, const Inputs& inputs) {
  Workspace& work = *work_;
  StepReport report;
  if (!is_usable(model_, inputs)) {
    report.status = StepStatus::bad_input;
    return report;
  }
  work.backup = state;
  // A tool that was not in the hand before has no way behind it.
  const Inputs last = inputs.tool >= 0 && state.last_inputs.tool == inputs.tool ? state.last_inputs : inputs;
  Workspace::Grip grip;
  grip.tool = inputs.tool >= 0 ? &model_.tools[std::size_t(inputs.tool)] : nullptr;
  grip.from = last.position, grip.to = inputs.position;
  if (grip.is(ToolKind::scalpel)) {
    grip.blade = blade_edge(*grip.tool, inputs);
    report.severed +=
        sever_swept_by_blade(model_, blade_edge(*grip.tool, last), grip.blade, state.position, state);
  }
  work.held_axes = model_.held_axes;
  work.pinned = grip.is(ToolKind::pin) ? grip.tool->sphere : -1;
  if (work.pinned >= 0) work.held_axes[std::size_t(work.pinned)] = kAnchored;

  const std::int32_t substeps = model_.solver.substeps;
  const double h = model_.tick / substeps;
  for (std::int32_t k = 1; k <= substeps; ++k) {
    const double share = double(k) / substeps;
    if (work.substep(state, grip, h, share, (double(state.tick) + share) * model_.tick, report)) continue;
    std::swap(state, work.backup);
    return report;
  }
  work.report_tool(state, h, report);
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
    if (report.status == StepStatus::diverged) break;
    const Vec3 fastest = state.velocity[std::size_t(report.worst_sphere)];
    if (norm(fastest) < kAtRest) break;
  }
  state.tick = start;
  work_->has_loads = true;
  return report;
}

}  // namespace ctpm
