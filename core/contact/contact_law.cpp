#include "core/contact/contact_law.h"

#include <algorithm>
#include <cmath>

namespace ctpm::contact {

double contact_damping(double hunt_crossley, double k, double mass, double penetration) {
  return std::min(hunt_crossley * k * penetration, 2 * std::sqrt(k * mass));
}

Foundation::Foundation(const OrganRange& organ, double static_k, double h) {
  const double k2 = organ.instant_ratio * static_k;
  if (organ.instant_ratio <= 1) {
    k = k2;
    return;
  }
  // Relative to K1: K2, and the step over the Kelvin unit's time.
  const double stiff = organ.instant_ratio - 1, step = h / (organ.kelvin_time + h * (1 + stiff));
  follows = stiff * step, keeps = 1 - (1 + stiff) * step;
  k = k2 * (1 - follows), relaxed = k2 * keeps;
}

double dent_stiffness(double modulus, double a, double unresolved) {
  constexpr double kPlane = 1 - 0.25 * 0.25;  // 1 - nu^2
  const double x = a / unresolved;
  return 0.6 * modulus / kPlane * (1 + x * (0.5 + 0.85 * x * x / (x + 1.5))) / a;
}

ContactShares::ContactShares(double k, double c) {
  if (k > 4) before = 1 / k, after = 1 - 3 * before;
  if (c > 2) damped_before = 1 / c, damped_after = 1 - damped_before;
}

}  // namespace ctpm::contact
