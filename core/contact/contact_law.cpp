#include "core/contact/contact_law.h"

#include <algorithm>
#include <cmath>

namespace ctpm::contact {

double contact_damping(double hunt_crossley, double k, double mass, double penetration) {
  return std::min(hunt_crossley * k * penetration, 2 * std::sqrt(k * mass));
}

double contact_drag(const Model& model, double penetration, double speed) {
  const double k = model.contact_k, stick = model.contact_stick_time * k,
               limit = model.contact_friction * k * penetration;
  return model.contact_friction > 0 ? (speed * stick > limit ? limit / speed : stick) : 0.0;
}

ContactShares::ContactShares(double k, double c) {
  if (k > 4) before = 1 / k, after = 1 - 3 * before;
  if (c > 2) damped_before = 1 / c, damped_after = 1 - damped_before;
}

}  // namespace ctpm::contact
