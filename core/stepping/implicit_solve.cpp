#include "core/stepping/implicit_solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/stepping/integrator.h"
#include "core/stepping/motion.h"

namespace ctpm::stepping {
namespace {

/// Solves of a step are repeated at most this often after contacts that would pull are dropped.
constexpr int kContactRounds = 4;

}  // namespace

ImplicitSolve::ImplicitSolve(const StepContext& context)
    : context_(context),
      held_(context.model, context.elements.slabs()),
      solver_(context.model, context.elements, context.team, context.kernels,
              stiffness_ratio_bound(context.model, context.model.tick / context.model.solver.substeps)),
      force_(3 * context.model.sphere_count()),
      momentum_(3 * context.model.sphere_count()),
      velocity_(3 * context.model.sphere_count()),
      blocks_(6 * context.model.sphere_count()) {
  const Model& model = context.model;
  context.elements.prepare_linearise(model.tick / model.solver.substeps);
  limits_.relative = model.solver.tolerance;
  limits_.max_iterations = model.solver.max_iterations;
}

const elements::Coordinates& ImplicitSolve::solve(const StateView& start, const Substep& part,
                                                  contact::ImplicitContacts& contacts, StepReport& report) {
  const ExternalLoads loads{context_.model, part.time, part.has_loads};
  const parallel::Slabs& slabs = context_.elements.slabs();
  slabs.for_each_awake(context_.team, [&](int slab) { begin(start, contacts.step().pins, loads, slab); });
  const solver::FirstGuess guess{solver_.energy_of(velocity_), false};
  // The first residual needs the coupling times the guess, which is multiplied while the coupling is at hand.
  context_.elements.linearise(
      start, part.h, false, force_, blocks_, [&](int slab) { begin_blocks(slab); }, velocity_.data(),
      solver_.product().data());
  const auto resistance = context_.resistance.linearise(start, part.h, force_, blocks_);
  solve_contacts({start.velocity, nullptr, guess}, contacts, resistance, velocity_, report);
  return velocity_;
}

const elements::Coordinates& ImplicitSolve::solve_near(const StateView& predicted, const Vec3Array& before,
                                                       bool keeps_matrix, const Substep& part,
                                                       contact::ImplicitContacts& contacts,
                                                       elements::Coordinates& change, StepReport& report) {
  const ExternalLoads loads{context_.model, part.time, part.has_loads};
  const auto begin_slab = [&](int slab) { begin(predicted, contacts.step().pins, loads, slab); };
  if (keeps_matrix)
    context_.elements.add_forces(predicted, force_, begin_slab, [](int) {});
  else
    context_.elements.linearise(predicted, part.h, true, force_, blocks_,
                                [&](int slab) { begin_slab(slab), begin_blocks(slab); });
  const auto resistance = context_.resistance.linearise(predicted, part.h, force_, blocks_);
  const auto for_coordinates = [&](auto&& act) {
    const parallel::Slabs& slabs = context_.elements.slabs();
    slabs.for_each_awake(context_.team, [&](int slab) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t from = axis * context_.model.sphere_count();
        act(from + std::size_t(slabs.begin(slab)), from + std::size_t(slabs.end(slab)));
      }
    });
  };
  for_coordinates(
      [&](std::size_t begin, std::size_t end) { std::fill(change.data() + begin, change.data() + end, 0.0); });
  solve_contacts({before, &predicted.velocity, {energy_of(velocity_), true}}, contacts, resistance, change, report);
  for_coordinates([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) velocity_[i] += change[i];
  });
  return velocity_;
}

/// Writes the external forces, to which the tissue adds its own, and the first guess of the velocity.
void ImplicitSolve::begin(const StateView& state, const contact::Pins& pins, const ExternalLoads& loads, int slab) {
  const parallel::Slabs& slabs = context_.elements.slabs();
  const auto first = std::size_t(slabs.begin(slab)), last = std::size_t(slabs.end(slab));
  const std::size_t n = context_.model.sphere_count();
  const double* now[3] = {state.velocity.x.data(), state.velocity.y.data(), state.velocity.z.data()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    std::copy(now[axis] + first, now[axis] + last, &velocity_[axis * n + first]);
  held_.stop(pins, slab, {&velocity_[0], &velocity_[n], &velocity_[2 * n]});
  loads.set(first, last, force_);
}

/// Writes the masses, to which the tissue adds its blocks.
void ImplicitSolve::begin_blocks(int slab) {
  const parallel::Slabs& slabs = context_.elements.slabs();
  const Model& model = context_.model;
  const auto first = std::size_t(slabs.begin(slab)), last = std::size_t(slabs.end(slab));
  for (std::size_t k = 0; k < 6; ++k) {
    const bool is_diagonal = k == 0 || k == 3 || k == 5;
    for (std::size_t i = first; i < last; ++i)
      blocks_[k * model.sphere_count() + i] = is_diagonal ? model.mass[i] : 0.0;
  }
}

/// Solves until no contact pulls or draws its point too far. `change` is the velocity itself, or its change from a
/// predictor.
void ImplicitSolve::solve_contacts(const Beginning& beginning, contact::ImplicitContacts& contacts,
                                   const inversion::LinearisedResistance& resistance, elements::Coordinates& change,
                                   StepReport& report) {
  const parallel::Slabs& slabs = context_.elements.slabs();
  const contact::ContactStep& step = contacts.step();
  const double root_of_mass = std::sqrt(context_.sleepers.awake_mass());
  limits_.absolute = context_.model.solver.velocity_floor * root_of_mass;
  limits_.enough = context_.model.solver.velocity_enough * root_of_mass;
  for (int round = 0;; ++round) {
    contact::LinearisedContacts linearised = contacts.linearise(force_, blocks_);
    slabs.for_each_awake(context_.team, [&](int slab) { find_momentum(beginning, step.h, slab); });
    solver_.set_blocks(blocks_, std::array{step.pins[0].sphere, step.pins[1].sphere});
    const solver::SolverOutcome outcome = solver_.solve(
        momentum_, change, round == 0 ? std::optional(beginning.guess) : std::nullopt, limits_,
        [&](const double* in, double* out, bool has_elements) {
          if (!has_elements) context_.elements.apply(in, out);
          resistance.apply(in, out), linearised.apply(in, out);
        },
        [&](const auto* in, auto* out) {
          context_.elements.apply_lagged(in, out);
          resistance.apply_lagged(in, out), linearised.apply_lagged(in, out);
        });
    report.iterations += outcome.iterations;
    report.residual = outcome.residual;
    if (!outcome.converged) report.status = StepStatus::not_converged;
    if (round < kContactRounds && linearised.has_wrong(change)) {
      std::move(linearised).mend_wrong(change);
      continue;
    }
    return report_forces(beginning, step, linearised, resistance, change, report);
  }
}

/// momentum = mass * (velocity - prediction) + h * force [kg m/s], for a slab's spheres.
void ImplicitSolve::find_momentum(const Beginning& beginning, double h, int slab) {
  const parallel::Slabs& slabs = context_.elements.slabs();
  const std::size_t n = context_.model.sphere_count(), begin = std::size_t(slabs.begin(slab)),
                    end = std::size_t(slabs.end(slab));
  const double* mass = context_.model.mass.data();
  for (const auto& [axis, of] : {std::pair{0, &Vec3Array::x}, {1, &Vec3Array::y}, {2, &Vec3Array::z}}) {
    const double *f = &force_[std::size_t(axis) * n], *v = (beginning.before.*of).data();
    const double* from = beginning.prediction != nullptr ? (beginning.prediction->*of).data() : nullptr;
    double* __restrict out = &momentum_[std::size_t(axis) * n];
    if (from == nullptr)
      for (std::size_t i = begin; i < end; ++i) out[i] = mass[i] * v[i] + h * f[i];
    else
      for (std::size_t i = begin; i < end; ++i) out[i] = mass[i] * (v[i] - from[i]) + h * f[i];
  }
}

/// Reports the force on each hand's tool: on a pin, the momentum balance of its sphere, with opposite sign.
void ImplicitSolve::report_forces(const Beginning& beginning, const contact::ContactStep& step,
                                  const contact::LinearisedContacts& contacts,
                                  const inversion::LinearisedResistance& resistance,
                                  const elements::Coordinates& change, StepReport& report) {
  const Model& model = context_.model;
  const std::size_t n = model.sphere_count();
  if (contact::any_held(step.pins)) {
    std::fill(momentum_.begin(), momentum_.end(), 0.0);
    context_.elements.apply(change.data(), momentum_.data());
    resistance.apply(change.data(), momentum_.data());
  }
  for (std::size_t hand = 0; hand < kMostHands; ++hand) {
    const contact::Pin& pin = step.pins[hand];
    if (!pin.is_held()) {
      report.of_hand(hand).tool_force = contacts.tool_force(hand, change);
      continue;
    }
    const std::size_t i = pin.index();
    const Vec3 coupling{momentum_[i], momentum_[n + i], momentum_[2 * n + i]},
        own{force_[i], force_[n + i], force_[2 * n + i]};
    report.of_hand(hand).tool_force = (model.mass[i] * (beginning.before[i] - pin.velocity) - coupling) / step.h + own;
  }
}

}  // namespace ctpm::stepping
