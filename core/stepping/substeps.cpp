#include <algorithm>
#include <span>
#include <utility>

#include "core/elements/only_springs.h"
#include "core/stepping/workspace.h"

namespace ctpm {
namespace {

/// A sphere faster than this [m/s] has left every physical range; the step is refused.
constexpr double kFastest = 1e4;

/// Part of a step that each of Alexander's two stages (1977) takes: 1 - 1 / sqrt(2).
constexpr double kStage = 0.29289321881345248;

/// A guess leads astray where it carries a sphere farther than this part of the shortest element in a step.
constexpr double kFarAhead = 0.1;

/// The motion is not resolved where a guess misses more than this part of the kinetic energy.
constexpr double kUnforeseen = 0.01;

/// to = from + factor * (to - from).
void stretch(const std::vector<double>& from, double factor, std::vector<double>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i] + factor * (to[i] - from[i]);
}

void stretch(const Vec3Array& from, double factor, Vec3Array& to) {
  stretch(from.x, factor, to.x), stretch(from.y, factor, to.y), stretch(from.z, factor, to.z);
}

/// velocity += h * acceleration.
void lead(const Vec3Array& acceleration, double h, Vec3Array& velocity) {
  for (std::size_t i = 0; i < velocity.size(); ++i) velocity.add(i, h * acceleration[i]);
}

/// slope = (to - from) / h.
void find_slope(const Vec3Array& from, const Vec3Array& to, double h, Vec3Array& slope) {
  for (std::size_t i = 0; i < to.size(); ++i) slope.set(i, (to[i] - from[i]) / h);
}

double fastest_squared(const Vec3Array& velocity) {
  double fastest = 0;
  for (std::size_t i = 0; i < velocity.size(); ++i) fastest = std::max(fastest, dot(velocity[i], velocity[i]));
  return fastest;
}

}  // namespace

/// Refuses velocities that no tissue has; names the fastest sphere.
bool Stepper::Workspace::check(StepReport& report) {
  const std::size_t n = model.sphere_count();
  const Slabs& slabs = elements.slabs();
  fastest_of_slab.resize(std::size_t(slabs.count()));
  team.for_each(slabs.count(), [&](int slab) {
    fastest_of_slab[std::size_t(slab)] =
        kernels.fastest_squared(n, velocity.data(), std::size_t(slabs.begin(slab)), std::size_t(slabs.end(slab)));
  });
  const auto fastest = std::max_element(fastest_of_slab.begin(), fastest_of_slab.end());
  const auto slab = int(fastest - fastest_of_slab.begin());
  report.worst_sphere = slabs.begin(slab);
  for (std::int32_t sphere = slabs.begin(slab); sphere < slabs.end(slab); ++sphere) {
    const auto i = std::size_t(sphere);
    const double squared =
        velocity[i] * velocity[i] + velocity[n + i] * velocity[n + i] + velocity[2 * n + i] * velocity[2 * n + i];
    if (squared < *fastest) continue;  // not so if it is not a number
    report.worst_sphere = sphere;
    break;
  }
  if (*fastest <= kFastest * kFastest) return true;
  report.status = StepStatus::diverged;
  return false;
}

/// Where the spheres are when they have moved for `h` [s] with the velocity of State.
void Stepper::Workspace::drift(double h, const State& state, Vec3Array& position) {
  const Slabs& slabs = elements.slabs();
  team.for_each(slabs.count(), [&](int slab) {
    for (const auto axis : {&Vec3Array::x, &Vec3Array::y, &Vec3Array::z}) {
      const double *v = (state.velocity.*axis).data(), *p = (state.position.*axis).data();
      double* __restrict to = (position.*axis).data();
      for (auto i = std::size_t(slabs.begin(slab)); i < std::size_t(slabs.end(slab)); ++i) to[i] = p[i] + h * v[i];
    }
  });
}

/// Takes the velocity that was solved for, and moves with it for `h` [s].
void Stepper::Workspace::go_on(State& state, double h) {
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
}

/// What a scalpel meets, and lips that meet again.
void Stepper::Workspace::find_pairs(const State& state, const Grip& grip) {
  if constexpr (kOnlySprings) return;
  pairs.clear();
  if (grip.is(ToolKind::scalpel) && blade.any()) {
    near->follow(state.position);
    blade.find(state, *near, *grip.tool, grip.blade, pairs);
    blade.add_severed(state, *grip.tool, grip.blade, std::span(crossings).first(grip.swept), pairs);
  }
  if (lips.is_wanted()) lips.find(state, pairs);
}

/// What the tool and the lips of cuts touch in a step of `h` [s], with the hand at `share` of its way. Implicit solves
/// start from State::velocity if that `is_guess`, else from rest; explicit ones go on from it.
void Stepper::Workspace::find_contacts(const State& state, const Grip& grip, double h, double share, bool is_guess) {
  contact.clear();
  find_pairs(state, grip);
  if (is_guess) pairs.start_from(state.velocity);
  if (!kOnlySprings && grip.is(ToolKind::ball))
    contact.find(state, grip.at(share), grip.tool->radius, (grip.to - grip.from) / model.tick, h,
                 is_guess || choice.integrator == Integrator::leapfrog);
}

/// One substep. False: it must be refused.
bool Stepper::Workspace::advance(State& state, const Grip& grip, const Substep& part, StepReport& report) {
  switch (choice.integrator) {
    case Integrator::leapfrog:
      return leap(state, grip, part, report);
    case Integrator::sdirk2:
      return sdirk(state, grip, part, report);
    default:
      return euler(state, grip, part, report);
  }
}

/// Position Verlet; a State that is refused stays as it was.
bool Stepper::Workspace::leap(State& state, const Grip& grip, const Substep& part, StepReport& report) {
  const double half = 0.5 * part.h;
  Outside outside{part.h, part.time - half, has_loads, contact, pairs, held_axes, pinned};
  const auto pin = std::size_t(pinned);
  if (pinned >= 0) {
    outside.velocity_before_pin = state.velocity[pin];
    outside.pin_velocity = (grip.at(part.share) - state.position[pin]) / part.h;
    state.velocity.set(pin, outside.pin_velocity);
  }
  drift(half, state, other.position);
  std::swap(state.position, other.position);
  elements.find_acting_kelvin(part.h, state, other.kelvin_elongation);
  std::swap(state.kelvin_elongation, other.kelvin_elongation);
  find_contacts(state, grip, part.h, part.share - half / model.tick, false);
  explicit_solver->solve(elements, state, outside, velocity, report);
  std::swap(state.kelvin_elongation, other.kelvin_elongation);
  if (!check(report)) {
    std::swap(state.position, other.position);
    if (pinned >= 0) state.velocity.set(pin, outside.velocity_before_pin);
    return false;
  }
  elements.finish_kelvin(part.h, other.kelvin_elongation, state);
  go_on(state, half);
  return true;
}

/// One step of backward Euler.
bool Stepper::Workspace::euler(State& state, const Grip& grip, const Substep& part, StepReport& report) {
  Outside outside{part.h, part.time, has_loads, contact, pairs, held_axes, pinned};
  if (pinned >= 0) outside.pin_velocity = (grip.at(part.share) - state.position[std::size_t(pinned)]) / part.h;
  find_contacts(state, grip, part.h, part.share, false);
  implicit_solver->solve(elements, state, outside, velocity, report);
  if (!check(report)) return false;
  go_on(state, part.h);
  elements.advance_kelvin(part.h, state);
  return true;
}

/// As above, linearised about where the guess in other.velocity leads; a second stage with the matrix of the first.
bool Stepper::Workspace::stage(State& state, const Grip& grip, const Substep& part, bool is_second,
                               StepReport& report) {
  Outside outside{part.h, part.time, has_loads, contact, pairs, held_axes, pinned};
  if (pinned >= 0) {
    outside.pin_velocity = (grip.at(part.share) - state.position[std::size_t(pinned)]) / part.h;
    other.velocity.set(std::size_t(pinned), outside.pin_velocity);
  }
  std::swap(state.velocity, other.velocity);
  drift(part.h, state, other.position);
  std::swap(state.position, other.position);
  // The matrix has what the Kelvin elongations do in the step; without a new one they must have done it before.
  if (is_second) elements.find_kelvin(part.h, state, other.kelvin_elongation);
  if (is_second) std::swap(state.kelvin_elongation, other.kelvin_elongation);
  find_contacts(state, grip, part.h, part.share, true);
  implicit_solver->solve_near(elements, state, other.velocity, is_second, outside, velocity, report);
  if (is_second) std::swap(state.kelvin_elongation, other.kelvin_elongation);
  std::swap(state.position, other.position);
  if (!check(report)) return false;
  go_on(state, part.h);
  elements.advance_kelvin(part.h, state);
  return true;
}

/// SDIRK2: L-stable, second order (Alexander, "Diagonally implicit Runge-Kutta methods for stiff O.D.E.'s", 1977). Two
/// stages, each a shorter step of backward Euler; the second starts where the first leads in the rest of the step. A
/// step that is too long for the motion is done by backward Euler alone.
bool Stepper::Workspace::sdirk(State& state, const Grip& grip, const Substep& part, StepReport& report) {
  start.position = state.position, start.velocity = state.velocity, start.kelvin_elongation = state.kelvin_elongation;
  if (state.acceleration.size() == 0) state.acceleration.resize(model.sphere_count());
  const StepStatus before = report.status;
  const double h = kStage * part.h, limit = kFarAhead * shortest_element;
  const double jump = pinned >= 0 ? norm(grip.at(part.share) - state.position[std::size_t(pinned)]) : 0.0;
  const bool is_near = jump <= limit && fastest_squared(state.velocity) * part.h * part.h <= limit * limit;
  if (is_near && two_stages(state, grip, part, h, report) &&
      implicit_solver->unforeseen(velocity, pinned) <= kUnforeseen) {
    find_slope(other.velocity, state.velocity, h, state.acceleration);
    return true;
  }
  state.position = start.position, state.velocity = start.velocity, state.kelvin_elongation = start.kelvin_elongation;
  report.status = before;
  if (!euler(state, grip, part, report)) return false;
  find_slope(start.velocity, state.velocity, part.h, state.acceleration);
  return true;
}

bool Stepper::Workspace::two_stages(State& state, const Grip& grip, const Substep& part, double h, StepReport& report) {
  const double rest = part.h - h;
  other.velocity = state.velocity;
  lead(state.acceleration, h, other.velocity);
  if (!stage(state, grip, {h, part.time - rest, part.share - rest / model.tick}, false, report)) return false;
  other.velocity = state.velocity;
  stretch(start.velocity, part.h / h, other.velocity);
  stretch(start.position, rest / h, state.position), stretch(start.velocity, rest / h, state.velocity);
  stretch(start.kelvin_elongation, rest / h, state.kelvin_elongation);
  return stage(state, grip, {h, part.time, part.share}, true, report);
}

}  // namespace ctpm
