#include "core/stepping/sdirk2.h"

#include <algorithm>
#include <limits>

namespace ctpm::stepping {
namespace {

/// Part of a step that each of Alexander's two stages (1977) takes: 1 - 1 / sqrt(2).
constexpr double kStage = 0.29289321881345248;

/// Falls back to backward Euler if a sphere moves farther in a step than 10 % of the shortest element.
constexpr double kLongestMove = 0.1;

/// Falls back to backward Euler if the predictor misses more than 1 % of the kinetic energy.
constexpr double kLargestPredictorError = 0.01;

/// to = from + factor * (to - from).
void stretch(const std::vector<double>& from, double factor, std::vector<double>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i] + factor * (to[i] - from[i]);
}

void stretch(const Vec3Array& from, double factor, Vec3Array& to) {
  stretch(from.x, factor, to.x), stretch(from.y, factor, to.y), stretch(from.z, factor, to.z);
}

/// to = velocity + h * acceleration; the acceleration is 0 if none is known.
void extrapolate(const Vec3Array& velocity, const Vec3Array& acceleration, double h, Vec3Array& to) {
  const bool is_known = acceleration.size() > 0;
  for (std::size_t i = 0; i < to.size(); ++i) to.set(i, velocity[i] + h * (is_known ? acceleration[i] : Vec3{}));
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
  if (is_short(from, tools, part) && two_stages(from, tools, part, to, report) &&
      predictor_error(stage_pins_) <= kLargestPredictorError) {
    find_slope(second_start_.velocity, to.velocity, kStage * part.h, to.acceleration);
    return true;
  }
  report.status = before;
  ++report.fallbacks;
  if (!fallback_.step(from, tools, part, to, report)) return false;
  find_slope(from.velocity, to.velocity, part.h, to.acceleration);
  return true;
}

/// Whether every sphere moves so little in the step that a predictor is good enough.
bool Sdirk2::is_short(const State& from, const contact::HeldTools& tools, const Substep& part) const {
  const double limit = kLongestMove * shortest_element_;
  double jump = 0;
  for (const contact::HeldTool& tool : tools)
    if (tool.is(ToolKind::pin))
      jump = std::max(jump, norm(tool.at(part.share) - from.position[std::size_t(tool.tool->sphere)]));
  return jump <= limit && fastest_squared(from.velocity) * part.h * part.h <= limit * limit;
}

bool Sdirk2::two_stages(const State& from, const contact::HeldTools& tools, const Substep& part, Motion& to,
                        StepReport& report) {
  const double h = kStage * part.h, rest = part.h - h;
  extrapolate(from.velocity, from.acceleration, h, predicted_.velocity);
  const Substep first{h, part.time - rest, part.share - rest / context_.model.tick, part.has_loads};
  if (!dirk_stage(from, tools, first, false, second_start_, report)) return false;
  predicted_.velocity = second_start_.velocity;
  stretch(from.velocity, part.h / h, predicted_.velocity);
  stretch(from.position, rest / h, second_start_.position), stretch(from.velocity, rest / h, second_start_.velocity);
  stretch(from.kelvin_elongation, rest / h, second_start_.kelvin_elongation);
  const StateView start(from, second_start_.position, second_start_.velocity, second_start_.kelvin_elongation);
  return dirk_stage(start, tools, {h, part.time, part.share, part.has_loads}, true, to, report);
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
  stage_velocity_ = &solve_.solve_near(predicted, start.velocity, is_second, part, contacts, change_, report);
  commit_velocity(slabs, context_.team, *stage_velocity_, start.position, part.h, to);
  if (!check_.passes(to.velocity, report)) return false;
  elements.find_kelvin(part.h, {start, to.position, to.velocity, start.kelvin_elongation}, to.kelvin_elongation);
  finish_contacts(contacts, tools, part, to, report);
  return true;
}

/// Share of the kinetic energy at the end of the last stage that its predictor missed; the pins' spheres do not count.
double Sdirk2::predictor_error(const contact::Pins& pins) {
  const std::size_t n = context_.model.sphere_count();
  const elements::Coordinates& velocity = *stage_velocity_;
  double energy = solve_.energy_of(velocity);
  for (const contact::Pin& pin : pins) {
    if (!pin.is_held()) continue;
    const std::size_t i = pin.index();
    const Vec3 own{velocity[i], velocity[n + i], velocity[2 * n + i]};
    energy -= context_.model.mass[i] * dot(own, own);
  }
  return energy > 0 ? solve_.energy_of(change_) / energy : 0.0;
}

}  // namespace ctpm::stepping
