#include "core/stepping/leapfrog.h"

#include "core/stepping/external_loads.h"

namespace ctpm::stepping {

Leapfrog::Leapfrog(const StepContext& context)
    : context_(context),
      held_(context.model, context.elements.slabs()),
      check_(context),
      force_(3 * context.model.sphere_count()) {
  const Model& model = context.model;
  per_mass_.reserve(model.sphere_count());
  for (const double mass : model.mass) per_mass_.push_back(1 / mass);
  if (model.has_tool(ToolKind::pin)) pinned_velocity_.resize(model.sphere_count());
}

bool Leapfrog::step(const State& from, const contact::HeldTools& tools, const Substep& part, Motion& to,
                    StepReport& report) {
  const Model& model = context_.model;
  elements::Elements& elements = context_.elements;
  const parallel::Slabs& slabs = elements.slabs();
  const double half = 0.5 * part.h;
  const contact::Pins pins = contact::Contacts::pins(tools, from.position, part.share, part.h);
  const Vec3Array& velocity = start_velocity(from, pins);
  context_.sleepers.keep(from, to);  // contacts are looked for there
  drift(slabs, context_.team, from.position, velocity, half, to.position);
  elements.find_acting_kelvin(part.h, {from, to.position, velocity, from.kelvin_elongation}, to.kelvin_elongation);

  const StateView middle(from, to.position, velocity, to.kelvin_elongation);
  kick(middle, pins, part, to.velocity);
  const std::array<Vec3, kMostHands> on_pin = context_.resistance.push_out(middle, part.h, pins, to.velocity);
  contact::ExplicitContacts contacts =
      context_.contacts.detect_in_middle(middle, tools, {part.h, part.h, half, part.share - half / model.tick, pins});
  if (context_.sleepers.wakes(contacts)) return false;
  contacts.push_apart(middle.velocity, to.velocity);
  for (std::size_t hand = 0; hand < kMostHands; ++hand) {
    const contact::Pin& pin = pins[hand];
    Vec3& tool_force = report.of_hand(hand).tool_force;
    tool_force = contacts.tool_force(hand);
    if (!pin.is_held()) continue;
    const std::size_t i = pin.index(), n = model.sphere_count();
    const Vec3 own{force_[i], force_[n + i], force_[2 * n + i]};
    tool_force = own + on_pin[hand] + model.mass[i] * (from.velocity[i] - pin.velocity) / part.h;
  }
  if (!check_.passes(to.velocity, report)) return false;

  elements.finish_kelvin(from.kelvin_elongation, to.kelvin_elongation);
  drift(slabs, context_.team, to.velocity, half, to.position);
  finish_contacts(contacts, tools, part, to, report);
  return true;
}

/// The velocity at the start, with the pins' spheres already moving to the hands.
const Vec3Array& Leapfrog::start_velocity(const State& from, const contact::Pins& pins) {
  if (!contact::any_held(pins)) return from.velocity;
  pinned_velocity_ = from.velocity;
  for (const contact::Pin& pin : pins)
    if (pin.is_held()) pinned_velocity_.set(pin.index(), pin.velocity);
  return pinned_velocity_;
}

/// velocity = v + h M^-1 f, with v and f at the middle of the step; contacts are added later.
void Leapfrog::kick(const StateView& middle, const contact::Pins& pins, const Substep& part, Vec3Array& velocity) {
  const std::size_t n = context_.model.sphere_count();
  const parallel::Slabs& slabs = context_.elements.slabs();
  const ExternalLoads loads{context_.model, part.time - 0.5 * part.h, part.has_loads};
  const double* old[3] = {middle.velocity.x.data(), middle.velocity.y.data(), middle.velocity.z.data()};
  const std::array<double*, 3> next = {velocity.x.data(), velocity.y.data(), velocity.z.data()};
  const auto start = [&](int slab) { loads.set(std::size_t(slabs.begin(slab)), std::size_t(slabs.end(slab)), force_); };
  const auto accelerate = [&](int slab) {
    const double h = part.h, *per_mass = per_mass_.data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double *force = &force_[axis * n], *v = old[axis];
      double* __restrict out = next[axis];
      for (auto i = std::size_t(slabs.begin(slab)); i < std::size_t(slabs.end(slab)); ++i)
        out[i] = v[i] + h * per_mass[i] * force[i];
    }
    held_.stop(pins, slab, next);
  };
  context_.elements.add_forces(middle, force_, start, accelerate);
}

}  // namespace ctpm::stepping
