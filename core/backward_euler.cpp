#include "core/backward_euler.h"

#include <algorithm>
#include <cmath>

namespace ctpm {
namespace {

/// Rounds in which contacts that would pull are dropped and the substep is solved again.
constexpr int kContactRounds = 4;

}  // namespace

BackwardEuler::BackwardEuler(const Model& model)
    : model_(model),
      jacobi_(model.sphere_count()),
      solver_(3 * model.sphere_count()),
      force_(3 * model.sphere_count()),
      momentum_(3 * model.sphere_count()),
      blocks_(6 * model.sphere_count()) {
  const double total_mass = fixed_order_dot(model.mass, std::vector<double>(model.mass.size(), 1.0));
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.held_axes[i] != 0 && model.held_axes[i] != kAnchored) guided_.push_back(std::int32_t(i));
  limits_.relative = model.solver.tolerance;
  limits_.absolute = model.solver.velocity_floor * std::sqrt(total_mass);
  limits_.max_iterations = model.solver.max_iterations;
}

void BackwardEuler::solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity,
                          StepReport& report) {
  const std::size_t n = model_.sphere_count();
  start_velocities(state, outside, velocity);
  set_outer_forces(model_, outside, force_);
  std::fill(blocks_.begin(), blocks_.end(), 0.0);
  for (const std::size_t diagonal : {std::size_t(0), 3 * n, 5 * n})
    std::copy(model_.mass.begin(), model_.mass.end(), blocks_.begin() + std::ptrdiff_t(diagonal));
  elements.linearise(state, outside.h, force_, blocks_);
  for (int round = 0;; ++round) {
    outside.contact.linearise(outside.h, force_, blocks_);
    outside.pairs.linearise(outside.h, force_, blocks_);
    const CgOutcome outcome = solve_round(elements, state, outside, velocity);
    report.iterations += outcome.iterations;
    report.residual = outcome.residual;
    if (!outcome.converged) report.status = StepStatus::not_converged;
    const bool pulls = outside.contact.has_pulling(outside.h, velocity) || outside.pairs.has_pulling(outside.h, velocity);
    if (round == kContactRounds || !pulls) return;
    outside.pairs.undo_linearise(force_, blocks_);
    outside.contact.undo_linearise(force_, blocks_);
    outside.contact.drop_pulling(outside.h, velocity);
    outside.pairs.drop_pulling(outside.h, velocity);
  }
}

/// Solves with the contacts there are, starting from `velocity`.
CgOutcome BackwardEuler::solve_round(const Elements& elements, const State& state, const Outside& outside,
                                     Coordinates& velocity) {
  const std::size_t n = model_.sphere_count();
  const double* old_velocity[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i)
      momentum_[axis * n + i] = outside.is_held(i, axis) ? 0.0
                                                         : model_.mass[i] * old_velocity[axis][i] +
                                                               outside.h * force_[axis * n + i];
  uncouple_guided(outside);
  jacobi_.factorise(blocks_);
  return solver_.solve(
      momentum_, velocity, limits_,
      [&](const Coordinates& in, Coordinates& out) {
        apply(elements, state, outside, in, out);
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (std::size_t i = 0; i < n; ++i)
            out[axis * n + i] = outside.is_held(i, axis) ? 0.0 : out[axis * n + i];
      },
      [&](const Coordinates& in, Coordinates& out) { jacobi_.apply(in, out); });
}

/// Product with the matrix of all spheres, held ones too.
void BackwardEuler::apply(const Elements& elements, const State& state, const Outside& outside,
                          const Coordinates& in, Coordinates& out) const {
  const std::size_t n = model_.sphere_count();
  const double* mass = model_.mass.data();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < n; ++i) out[axis * n + i] = mass[i] * in[axis * n + i];
  elements.apply(state, outside.h, in, out);
  if (outside.contact.count() > 0) outside.contact.apply(outside.h, in, out);
  if (outside.pairs.count() > 0) outside.pairs.apply(outside.h, in, out);
}

/// The preconditioner must not move a guided sphere along a held axis.
void BackwardEuler::uncouple_guided(const Outside& outside) {
  const std::size_t n = model_.sphere_count();
  for (const std::int32_t sphere : guided_) {
    const auto i = std::size_t(sphere);
    const bool x = outside.is_held(i, 0), y = outside.is_held(i, 1), z = outside.is_held(i, 2);
    if (x || y) blocks_[n + i] = 0;
    if (x || z) blocks_[2 * n + i] = 0;
    if (y || z) blocks_[4 * n + i] = 0;
  }
}

/// The pinned sphere's row of the balance of momentum, with the sign turned.
Vec3 BackwardEuler::force_on_pin(const Elements& elements, const State& state, const Outside& outside,
                                 const Coordinates& velocity) {
  const std::size_t n = model_.sphere_count();
  const auto i = std::size_t(outside.pinned);
  apply(elements, state, outside, velocity, momentum_);
  const Vec3 done{momentum_[i], momentum_[n + i], momentum_[2 * n + i]},
      own{force_[i], force_[n + i], force_[2 * n + i]};
  return (model_.mass[i] * state.velocity[i] + outside.h * own - done) / outside.h;
}

}  // namespace ctpm
