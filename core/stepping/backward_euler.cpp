#include "core/stepping/backward_euler.h"

#include <algorithm>
#include <cmath>

#include "core/elements/only_springs.h"
#include "core/stepping/integrator.h"

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
      solver_(model, slabs, team, kernels, stiffness_ratio_bound(model, model.tick / model.solver.substeps)),
      force_(3 * model.sphere_count()),
      momentum_(3 * model.sphere_count()),
      change_(model.solver.integrator == Integrator::sdirk2 ? 3 * model.sphere_count() : 0),
      blocks_(6 * model.sphere_count()) {
  double total_mass = 0;
  for (const double mass : model.mass) total_mass += mass;
  limits_.relative = model.solver.tolerance;
  limits_.absolute = model.solver.velocity_floor * std::sqrt(total_mass);
  limits_.max_iterations = model.solver.max_iterations;
}

void BackwardEuler::solve(Elements& elements, const State& state, Outside& outside, Coordinates& velocity,
                          StepReport& report) {
  elements.linearise(state, outside.h, false, force_, blocks_,
                     [&](int slab) { begin(state, outside, slab, velocity), begin_blocks(slab); });
  solve_contacts(elements, {state.velocity, nullptr, {}}, outside, velocity, report);
}

void BackwardEuler::solve_near(Elements& elements, const State& state, const Vec3Array& before, bool keeps_matrix,
                               Outside& outside, Coordinates& velocity, StepReport& report) {
  if (keeps_matrix)
    elements.add_forces(
        state, force_, [&](int slab) { begin(state, outside, slab, velocity); }, [](int) {});
  else
    elements.linearise(state, outside.h, true, force_, blocks_,
                       [&](int slab) { begin(state, outside, slab, velocity), begin_blocks(slab); });
  std::fill(change_.begin(), change_.end(), 0.0);
  solve_contacts(elements, {before, &state.velocity, solver_.energy_of(velocity)}, outside, change_, report);
  outside.pairs.undo_linearise(force_, blocks_);
  outside.contact.undo_linearise(force_, blocks_);
  for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] += change_[i];
}

double BackwardEuler::unforeseen(const Coordinates& velocity, std::int32_t pinned) {
  const std::size_t n = model_.sphere_count();
  double energy = solver_.energy_of(velocity);
  if (const auto i = std::size_t(pinned); pinned >= 0) {
    const Vec3 own{velocity[i], velocity[n + i], velocity[2 * n + i]};
    energy -= model_.mass[i] * dot(own, own);
  }
  return energy > 0 ? solver_.energy_of(change_) / energy : 0.0;
}

/// Forces from outside, ahead of the tissue's; `velocity` that of State.
void BackwardEuler::begin(const State& state, const Outside& outside, int slab, Coordinates& velocity) {
  const auto first = std::size_t(slabs_.begin(slab)), last = std::size_t(slabs_.end(slab));
  const double* now[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    std::copy(now[axis] + first, now[axis] + last, &velocity[axis * model_.sphere_count() + first]);
  held_.stop(outside, slab, velocity);
  set_weight(model_, first, last, force_);
  add_loads(model_, outside, first, last, force_);
}

/// The masses, ahead of the tissue's blocks.
void BackwardEuler::begin_blocks(int slab) {
  const auto first = std::size_t(slabs_.begin(slab)), last = std::size_t(slabs_.end(slab));
  for (std::size_t k = 0; k < 6; ++k) {
    const bool is_diagonal = k == 0 || k == 3 || k == 5;
    for (std::size_t i = first; i < last; ++i)
      blocks_[k * model_.sphere_count() + i] = is_diagonal ? model_.mass[i] : 0.0;
  }
}

/// Solves until no contact pulls.
void BackwardEuler::solve_contacts(const Elements& elements, const Beginning& beginning, Outside& outside,
                                   Coordinates& change, StepReport& report) {
  for (int round = 0;; ++round) {
    if constexpr (!kOnlySprings) {
      outside.contact.linearise(outside.h, force_, blocks_);
      outside.pairs.linearise(outside.h, force_, blocks_);
    }
    team_.for_each(slabs_.count(), [&](int slab) {
      find_momentum(model_, beginning.before, beginning.guess, outside.h, force_, std::size_t(slabs_.begin(slab)),
                    std::size_t(slabs_.end(slab)), momentum_);
    });
    const SolverOutcome outcome =
        solve_round(elements, outside, round == 0 ? beginning.guess_energy : std::nullopt, change);
    report.iterations += outcome.iterations;
    report.residual = outcome.residual;
    if (!outcome.converged) report.status = StepStatus::not_converged;
    if constexpr (kOnlySprings) return;
    const bool pulls = outside.contact.has_pulling(outside.h, change) || outside.pairs.has_pulling(outside.h, change);
    if (round == kContactRounds || !pulls) break;
    outside.pairs.undo_linearise(force_, blocks_);
    outside.contact.undo_linearise(force_, blocks_);
    outside.contact.drop_pulling(outside.h, change);
    outside.pairs.drop_pulling(outside.h, change);
  }
  report.tool_force = outside.contact.force_on_tool(outside.h, change) + outside.pairs.force_on_tool(outside.h, change);
  if (outside.pinned >= 0)
    report.tool_force = force_on_pin(elements, beginning.before[std::size_t(outside.pinned)], outside, change);
}

/// Solves with the contacts there are, starting from `change`, or from 0 beside a guess of that energy.
SolverOutcome BackwardEuler::solve_round(const Elements& elements, const Outside& outside, std::optional<double> energy,
                                         Coordinates& change) {
  solver_.set_blocks(blocks_, outside.pinned);
  return solver_.solve(momentum_, change, energy, limits_, [&](const auto* in, auto* out, auto&& after) {
    elements.apply(in, out, after);
    if constexpr (kOnlySprings) return 0.0;
    return outside.contact.apply(outside.h, in, out) + outside.pairs.apply(outside.h, in, out);
  });
}

/// The pinned sphere's row of the balance of momentum, with the sign turned; `before` is its velocity at the start.
Vec3 BackwardEuler::force_on_pin(const Elements& elements, Vec3 before, const Outside& outside,
                                 const Coordinates& change) {
  const std::size_t n = model_.sphere_count();
  const auto i = std::size_t(outside.pinned);
  std::fill(momentum_.begin(), momentum_.end(), 0.0);
  elements.apply(static_cast<const double*>(change.data()), momentum_.data(), [](int) {});
  const Vec3 coupling{momentum_[i], momentum_[n + i], momentum_[2 * n + i]},
      own{force_[i], force_[n + i], force_[2 * n + i]};
  return (model_.mass[i] * (before - outside.pin_velocity) - coupling) / outside.h + own;
}

}  // namespace ctpm
