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
      : model(m), axial(m), constraints(m), angles(m), contact(m), jacobi(m.sphere_count()), solver(3 * m.sphere_count()),
        force(3 * m.sphere_count()), momentum(3 * m.sphere_count()), velocity(3 * m.sphere_count()),
        blocks(6 * m.sphere_count()), softness(m.has_softening ? m.sphere_count() : 0), before(m.sphere_count()) {
    const double total_mass = fixed_order_dot(m.mass, std::vector<double>(m.mass.size(), 1.0));
    limits.relative = m.solver.tolerance;
    limits.absolute = m.solver.velocity_floor * std::sqrt(total_mass);
    limits.max_iterations = m.solver.max_iterations;
  }

  void linearise(const State& state, double h);
  void apply(const State& state, double h, const Coordinates& in, Coordinates& out) const;
  void solve(const State& state, double h, StepReport& report);
  bool check(StepReport& report) const;
  void advance(State& state, double h);

  const Model& model;
  AxialElements axial;
  ConstraintElements constraints;
  AngleElements angles;
  BallContact contact;
  BlockJacobi jacobi;
  ConjugateGradient solver;
  CgLimits limits;
  Coordinates force, momentum, velocity;
  DiagonalBlocks blocks;
  std::vector<double> softness;
  Vec3Array before;           ///< positions before the substep, for what moves through a blade
  State backup;               ///< State before the tick, in case it has to be refused
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
  if (model.has_softening) constraints.measure_tilt(state, softness);
  if (model.constraints.size() > 0) constraints.linearise(state, softness, h, force, blocks);
  if (model.angle_springs.size() > 0) angles.linearise(state, h, force, blocks);
  axial.linearise(state, softness, h, force, blocks);
}

void Stepper::Workspace::apply(const State& state, double h, const Coordinates& in, Coordinates& out) const {
  const std::size_t n = model.sphere_count();
  const double* mass = model.mass.data();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i) out[axis * n + i] = mass[i] * in[axis * n + i];
  axial.apply(in, out);
  if (model.constraints.size() > 0) constraints.apply(in, out);
  if (model.angle_springs.size() > 0) angles.apply(state, h, in, out);
  if (contact.count() > 0) contact.apply(h, in, out);
  for (std::size_t i = 0; i < n; ++i)
    if (model.is_fixed[i]) out[i] = out[n + i] = out[2 * n + i] = 0;
}

/// Velocity at the end of the substep; contacts only push.
void Stepper::Workspace::solve(const State& state, double h, StepReport& report) {
  const std::size_t n = model.sphere_count();
  const double* old_velocity[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i) velocity[axis * n + i] = model.is_fixed[i] ? 0.0 : old_velocity[axis][i];
  for (int round = 0;; ++round) {
    linearise(state, h);
    contact.linearise(h, force, blocks);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < n; ++i)
        momentum[axis * n + i] =
            model.is_fixed[i] ? 0.0 : model.mass[i] * old_velocity[axis][i] + h * force[axis * n + i];
    jacobi.factorise(blocks);
    const CgOutcome outcome = solver.solve(
        momentum, velocity, limits, [&](const Coordinates& in, Coordinates& out) { apply(state, h, in, out); },
        [&](const Coordinates& in, Coordinates& out) { jacobi.apply(in, out); });
    report.iterations += outcome.iterations;
    report.residual = outcome.residual;
    if (!outcome.converged) report.status = StepStatus::not_converged;
    if (round == kContactRounds || !contact.drop_pulling(h, velocity)) return;
  }
}

/// Refuses velocities that no tissue has; names the fastest sphere.
bool Stepper::Workspace::check(StepReport& report) const {
  const std::size_t n = model.sphere_count();
  double fastest_squared = -1;
  for (std::size_t i = 0; i < n; ++i) {
    const double squared = velocity[i] * velocity[i] + velocity[n + i] * velocity[n + i] + velocity[2 * n + i] * velocity[2 * n + i];
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
    double *__restrict p = position[axis]->data(), *__restrict v = speed[axis]->data();
    const double* __restrict next = &velocity[axis * n];
    for (std::size_t i = 0; i < n; ++i) v[i] = next[i], p[i] += h * next[i];
  }
  axial.advance_kelvin(state.position, h, state);
}

Stepper::Stepper(const Model& model) : model_(model), work_(std::make_unique<Workspace>(model)) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;

StepReport Stepper::step(State& state, const Inputs& inputs) {
  Workspace& work = *work_;
  StepReport report;
  if (!is_usable(model_, inputs)) {
    report.status = StepStatus::bad_input;
    return report;
  }
  work.backup = state;
  const Inputs last = state.last_inputs;
  const bool is_held = inputs.tool >= 0 && last.tool == inputs.tool;
  const Tool* tool = inputs.tool >= 0 ? &model_.tools[std::size_t(inputs.tool)] : nullptr;
  const bool cuts = tool && tool->kind == ToolKind::scalpel;
  if (cuts && is_held)
    report.severed += sever_swept_by_blade(model_, blade_edge(*tool, last), blade_edge(*tool, inputs), state.position, state);

  const std::int32_t substeps = model_.solver.substeps;
  const double h = model_.tick / substeps;
  const Vec3 from = is_held ? last.position : inputs.position;
  for (std::int32_t k = 1; k <= substeps; ++k) {
    work.contact.clear();
    if (tool && tool->kind == ToolKind::ball) {
      const double part = double(k) / substeps;
      work.contact.find(state, from + part * (inputs.position - from), tool->radius, (inputs.position - from) / model_.tick);
    }
    work.solve(state, h, report);
    if (!work.check(report)) {
      std::swap(state, work.backup);
      return report;
    }
    if (cuts) work.before = state.position;
    work.advance(state, h);
    if (cuts) report.severed += sever_moved_through_blade(model_, blade_edge(*tool, inputs), work.before, state.position, state);
  }
  report.tool_force = work.contact.force_on_tool(h, work.velocity);
  report.depth = work.contact.depth(state);
  report.contacts = work.contact.count();
  state.last_inputs = inputs;
  ++state.tick;
  return report;
}

StepReport Stepper::settle(State& state, std::int64_t ticks) {
  const std::int64_t start = state.tick;
  StepReport report;
  for (std::int64_t i = 0; i < ticks; ++i) {
    report = step(state, Inputs{});
    if (report.status == StepStatus::diverged) break;
    const Vec3 fastest = state.velocity[std::size_t(report.worst_sphere)];
    if (norm(fastest) < kAtRest) break;
  }
  state.tick = start;
  return report;
}

}  // namespace ctpm
