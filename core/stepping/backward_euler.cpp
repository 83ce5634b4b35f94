#include "core/stepping/backward_euler.h"

namespace ctpm::stepping {

bool BackwardEuler::step(const State& from, const contact::HeldTools& tools, const Substep& part, Motion& to,
                         StepReport& report) {
  const contact::Pins pins = contact::Contacts::pins(tools, from.position, part.share, part.h);
  contact::ImplicitContacts contacts =
      context_.contacts.detect(from, tools, {part.h, part.h, 0, part.share, pins}, contact::Linearisation::rest);
  if (context_.sleepers.wakes(contacts)) return false;
  context_.sleepers.keep_kelvin(from, to);
  const elements::Coordinates& velocity = solve_.solve(from, part, contacts, report);
  commit_velocity(context_.elements.slabs(), context_.team, velocity, from.position, part.h, to);
  if (!check_.passes(to.velocity, report)) return false;
  context_.elements.find_kelvin(part.h, {from, to.position, to.velocity, from.kelvin_elongation}, to.kelvin_elongation);
  finish_contacts(contacts, tools, part, to, report);
  return true;
}

}  // namespace ctpm::stepping
