#include "core/backward_euler.h"

#include <algorithm>
#include <cmath>

#include "core/only_springs.h"

namespace ctpm {
namespace {

/// Rounds in which contacts that would pull are dropped and the substep is solved again.
constexpr int kContactRounds = 4;

}  // namespace

BackwardEuler::BackwardEuler(const Model& model, const Slabs& slabs, Team& team, const Kernels& kernels)
    : model_(model),
      slabs_(slabs),
      team_(team),
      held_(model, slabs),
      solver_(model, slabs, team, kernels),
      force_(3 * model.sphere_count()),
      momentum_(3 * model.sphere_count()),
      blocks_(6 * model.sphere_count()) {
  double total_mass = 0;
  for (const double mass : model.mass) total_mass += mass;
  limits_.relative = model.solver.tolerance;
  limits_.absolute = model.solver.velocity_floor * std::sqrt(total_mass);
  limits_.max_iterations = model.solver.max_iterations;
}

void BackwardEuler::solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity,
                          StepReport& report) {
  const std::size_t n = model_.sphere_count();
  const double* old[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  elements.linearise(state, outside.h, force_, blocks_, [&](int slab) {
    const auto begin = std::size_t(slabs_.begin(slab)), end = std::size_t(slabs_.end(slab));
    for (std::size_t axis = 0; axis < 3; ++axis) std::copy(old[axis] + begin, old[axis] + end, &velocity[axis * n + begin]);
    held_.stop(outside, slab, velocity);
    set_weight(model_, begin, end, force_);
    add_loads(model_, outside, begin, end, force_);
    for (std::size_t k = 0; k < 6; ++k) {
      const bool is_diagonal = k == 0 || k == 3 || k == 5;
      for (std::size_t i = begin; i < end; ++i) blocks_[k * n + i] = is_diagonal ? model_.mass[i] : 0.0;
    }
  });
  for (int round = 0;; ++round) {
    if constexpr (!kOnlySprings) {
      outside.contact.linearise(outside.h, force_, blocks_);
      outside.pairs.linearise(outside.h, force_, blocks_);
    }
    const SolverOutcome outcome = solve_round(elements, state, outside, velocity);
    report.iterations += outcome.iterations;
    report.residual = outcome.residual;
    if (!outcome.converged) report.status = StepStatus::not_converged;
    if constexpr (kOnlySprings) return;
    const bool pulls = outside.contact.has_pulling(outside.h, velocity) || outside.pairs.has_pulling(outside.h, velocity);
    if (round == kContactRounds || !pulls) return;
    outside.pairs.undo_linearise(force_, blocks_);
    outside.contact.undo_linearise(force_, blocks_);
    outside.contact.drop_pulling(outside.h, velocity);
    outside.pairs.drop_pulling(outside.h, velocity);
  }
}

/// Solves with the contacts there are, starting from `velocity`.
SolverOutcome BackwardEuler::solve_round(const Elements& elements, const State& state, const Outside& outside,
                                     Coordinates& velocity) {
  team_.for_each(slabs_.count(), [&](int slab) {
    find_momentum(model_, state, outside.h, force_, std::size_t(slabs_.begin(slab)), std::size_t(slabs_.end(slab)),
                  momentum_);
  });
  solver_.set_blocks(blocks_, outside.pinned);
  return solver_.solve(momentum_, velocity, limits_, [&](const auto* in, auto* out, auto&& after) {
    elements.apply(in, out, after);
    if constexpr (kOnlySprings) return 0.0;
    return outside.contact.apply(outside.h, in, out) + outside.pairs.apply(outside.h, in, out);
  });
}

/// The pinned sphere's row of the balance of momentum, with the sign turned.
Vec3 BackwardEuler::force_on_pin(const Elements& elements, const State& state, const Outside& outside,
                                 const Coordinates& velocity) {
  const std::size_t n = model_.sphere_count();
  const auto i = std::size_t(outside.pinned);
  std::fill(momentum_.begin(), momentum_.end(), 0.0);
  elements.apply(static_cast<const double*>(velocity.data()), momentum_.data(), [](int) {});
  const Vec3 coupling{momentum_[i], momentum_[n + i], momentum_[2 * n + i]},
      own{force_[i], force_[n + i], force_[2 * n + i]};
  return (model_.mass[i] * (state.velocity[i] - outside.pin_velocity) - coupling) / outside.h + own;
}

}  // namespace ctpm
