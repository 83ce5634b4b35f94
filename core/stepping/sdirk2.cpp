#include "core/stepping/sdirk2.h"

#include <algorithm>
#include <limits>

namespace ctpm::stepping {
namespace {

/// Part of a step that each of Alexander's two stages (1977) takes: 1 - 1 / sqrt(2).
constexpr double kStage = 0.29289321881345248;

/// Falls back to backward Euler if a sphere moves farther in a step than 10 % of the shortest element.
constexpr double kLongestMove = 0.1;

/// Falls back to backward Euler if a stage's predictor misses more than 1 % of the kinetic energy.
constexpr double kLargestPredictorError = 0.01;

/// What solves leave undone, in velocity floors, once both stages' steps have stretched it: a predictor that misses
/// less than that is as good as known, however little moves.
constexpr double kLeftUndone = 1 / (kStage * kStage);

constexpr std::vector<double> Vec3Array::*kAxes[3] = {&Vec3Array::x, &Vec3Array::y, &Vec3Array::z};

/// Calls act(axis, begin, end) for the spheres of each slab, in parallel.
template <class Act>
void for_coordinates(const StepContext& context, const Act& act) {
  const parallel::Slabs& slabs = context.elements.slabs();
  slabs.for_each_awake(context.team, [&](int slab) {
    for (const auto axis : kAxes) act(axis, std::size_t(slabs.begin(slab)), std::size_t(slabs.end(slab)));
  });
}

/// to = from + factor * (to - from).
void stretch(const double* from, double factor, double* __restrict to, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) to[i] = from[i] + factor * (to[i] - from[i]);
}

void stretch(const StepContext& context, const Vec3Array& from, double factor, Vec3Array& to) {
  for_coordinates(context, [&](auto axis, std::size_t begin, std::size_t end) {
    stretch((from.*axis).data(), factor, (to.*axis).data(), begin, end);
  });
}

/// to = velocity + h * acceleration; the acceleration is 0 if none is known.
void extrapolate(const StepContext& context, const Vec3Array& velocity, const Vec3Array& acceleration, double h,
                 Vec3Array& to) {
  if (acceleration.size() > 0) return drift(context.elements.slabs(), context.team, velocity, acceleration, h, to);
  for_coordinates(context, [&](auto axis, std::size_t begin, std::size_t end) {
    const double* v = (velocity.*axis).data();
    double* __restrict out = (to.*axis).data();
    for (std::size_t i = begin; i < end; ++i) out[i] = v[i] + 0.0;
  });
}

/// slope = (to - from) / h.
void find_slope(const StepContext& context, const Vec3Array& from, const Vec3Array& to, double h, Vec3Array& slope) {
  for_coordinates(context, [&](auto axis, std::size_t begin, std::size_t end) {
    const double *first = (from.*axis).data(), *last = (to.*axis).data();
    double* __restrict out = (slope.*axis).data();
    for (std::size_t i = begin; i < end; ++i) out[i] = (last[i] - first[i]) / h;
  });
}

/// The kinetic energy that a predictor may always miss [J], twice.
double left_undone_in(const StepContext& context) {
  const SolverSettings& solver = context.model.solver;
  const double velocity = kLeftUndone * std::max(solver.velocity_floor, solver.velocity_enough);
  return context.sleepers.awake_mass() * velocity * velocity;
}

double shortest_element_of(const Model& model) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const double length : model.axial.rest_length) shortest = std::min(shortest, length);
  return shortest;
}

}  // namespace

Sdirk2::Sdirk2(const StepContext& context, ImplicitSolve& solve)
    : context_(context),
      solve_(solve),
      fallback_(context, solve),
      check_(context),
      shortest_element_(shortest_element_of(context.model)),
      predicted_(context.model),
      second_start_(context.model),
      change_(3 * context.model.sphere_count()) {}

bool Sdirk2::step(const State& from, const contact::HeldTools& tools, const Substep& part, Motion& to,
                  StepReport& report) {
  to.acceleration.resize(from.position.size());
  const StepStatus before = report.status;
  for (Motion* motion : {&predicted_, &second_start_}) context_.sleepers.keep(from, *motion);
  context_.sleepers.keep_kelvin(from, to);
  if (is_short(from, tools, part) && two_stages(from, tools, part, to, report)) {
    find_slope(context_, second_start_.velocity, to.velocity, kStage * part.h, to.acceleration);
    return true;
  }
  if (context_.sleepers.has_woken()) return false;
  report.status = before;
  ++report.fallbacks;
  if (!fallback_.step(from, tools, part, to, report)) return false;
  find_slope(context_, from.velocity, to.velocity, part.h, to.acceleration);
  return true;
}

/// Whether every sphere moves so little in the step that a predictor is good enough.
bool Sdirk2::is_short(const State& from, const contact::HeldTools& tools, const Substep& part) const {
  const double limit = kLongestMove * shortest_element_;
  double jump = 0;
  for (const contact::HeldTool& tool : tools)
    if (tool.is(ToolKind::pin))
      jump = std::max(jump, norm(tool.at(part.share) - from.position[std::size_t(tool.tool->sphere)]));
  const Vec3Array& v = from.velocity;
  const double fastest = context_.kernels.fastest_squared(v.x.data(), v.y.data(), v.z.data(), 0, v.size());
  return jump <= limit && fastest * part.h * part.h <= limit * limit;
}

/// False: a stage failed, or was too far from its predictor.
bool Sdirk2::two_stages(const State& from, const contact::HeldTools& tools, const Substep& part, Motion& to,
                        StepReport& report) {
  const double h = kStage * part.h, rest = part.h - h;
  extrapolate(context_, from.velocity, from.acceleration, h, predicted_.velocity);
  const Substep first{h, part.time - rest, part.share - rest / context_.model.tick, part.has_loads};
  if (!dirk_stage(from, tools, first, false, second_start_, report) || !was_predicted()) return false;
  predicted_.velocity = second_start_.velocity;
  stretch(context_, from.velocity, part.h / h, predicted_.velocity);
  stretch(context_, from.position, rest / h, second_start_.position);
  stretch(context_, from.velocity, rest / h, second_start_.velocity);
  stretch(from.kelvin_elongation.data(), rest / h, second_start_.kelvin_elongation.data(), 0,
          from.kelvin_elongation.size());
  const StateView start(from, second_start_.position, second_start_.velocity, second_start_.kelvin_elongation);
  return dirk_stage(start, tools, {h, part.time, part.share, part.has_loads}, true, to, report) && was_predicted();
}

/// One stage from `start` into `to`, linearised about the positions to which the velocity in predicted_ leads. The
/// second stage reuses the matrix of the first.
bool Sdirk2::dirk_stage(const StateView& start, const contact::HeldTools& tools, const Substep& part, bool is_second,
                        Motion& to, StepReport& report) {
  elements::Elements& elements = context_.elements;
  const parallel::Slabs& slabs = elements.slabs();
  stage_pins_ = contact::Contacts::pins(tools, start.position, part.share, part.h);
  for (const contact::Pin& pin : stage_pins_)
    if (pin.is_held()) predicted_.velocity.set(pin.index(), pin.velocity);
  drift(slabs, context_.team, start.position, predicted_.velocity, part.h, predicted_.position);
  // A new matrix accounts for the change of Kelvin elongations during the step; a reused one needs those at its end.
  if (is_second)
    elements.find_kelvin(part.h, {start, predicted_.position, predicted_.velocity, start.kelvin_elongation},
                         predicted_.kelvin_elongation);
  const std::vector<double>& kelvin = is_second ? predicted_.kelvin_elongation : start.kelvin_elongation;
  const StateView predicted(start, predicted_.position, predicted_.velocity, kelvin);
  const double elapsed = is_second ? part.h / kStage : part.h;  // the second stage ends with the step
  contact::ImplicitContacts contacts = context_.contacts.detect(
      predicted, tools, {part.h, elapsed, elapsed, part.share, stage_pins_}, contact::Linearisation::velocity);
  if (context_.sleepers.wakes(contacts)) return false;
  stage_velocity_ = &solve_.solve_near(predicted, start.velocity, is_second, part, contacts, change_, report);
  commit_velocity(slabs, context_.team, *stage_velocity_, start.position, part.h, to);
  if (!check_.passes(to.velocity, report)) return false;
  elements.find_kelvin(part.h, {start, to.position, to.velocity, start.kelvin_elongation}, to.kelvin_elongation);
  finish_contacts(contacts, tools, part, to, report);
  return true;
}

/// Whether the predictor of the last stage missed little of its kinetic energy; the pins' spheres do not count.
bool Sdirk2::was_predicted() {
  const std::size_t n = context_.model.sphere_count();
  const elements::Coordinates& velocity = *stage_velocity_;
  double energy = solve_.energy_of(velocity);
  for (const contact::Pin& pin : stage_pins_) {
    if (!pin.is_held()) continue;
    const std::size_t i = pin.index();
    const Vec3 own{velocity[i], velocity[n + i], velocity[2 * n + i]};
    energy -= context_.model.mass[i] * dot(own, own);
  }
  return solve_.energy_of(change_) <= std::max(left_undone_in(context_), kLargestPredictorError * energy);
}

}  // namespace ctpm::stepping
