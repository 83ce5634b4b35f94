#include "core/stepping/backward_euler.h"

namespace ctpm {

bool BackwardEuler::step(const State& from, const HeldTool& tool, const Substep& part, Motion& to, StepReport& report) {
  const Pin pin = Contacts::pin(tool, from.position, part.share, part.h);
  ImplicitContacts contacts = context_.contacts.detect(from, tool, {part.h, part.share, pin}, Linearisation::rest);
  const Coordinates& velocity = solve_.solve(from, part, contacts, report);
  commit_velocity(context_.elements.slabs(), context_.team, velocity, from.position, part.h, to);
  if (!check_.passes(to.velocity, report)) return false;
  context_.elements.find_kelvin(part.h, {from, to.position, to.velocity, from.kelvin_elongation}, to.kelvin_elongation);
  report.depth = contacts.depth(to.position), report.contacts = contacts.touched();
  return true;
}

}  // namespace ctpm
