#pragma once

#include "core/model/model.h"

namespace ctpm::contact {

/// Damping along the normal [N s/m] of a contact of stiffness `k` [N/m] with a sphere of `mass` [kg] at `penetration`
/// [m]. `hunt_crossley` [s/m] is c in the law k p (1 + c p') of Hunt & Crossley, "Coefficient of restitution
/// interpreted as damping in vibroimpact" (1975). The result never exceeds critical damping.
double contact_damping(double hunt_crossley, double k, double mass, double penetration);

/// Drag across the normal [N s/m] of a tool's contact at `penetration` [m] that slips at `speed` [m/s]. It is viscous
/// while the surfaces stick; Coulomb's law limits it when they slip.
double contact_drag(const Model& model, double penetration, double speed);

/// Weights of the velocities after and before an explicit step in the contact force at its middle. The defaults are
/// second order: 0.25 each in the penetration (Newmark's average acceleration) and 0.5 each in the damping. Where the
/// step is too long to resolve the contact, the velocity after it weighs more, so that the contact does not ring.
struct ContactShares {
  /// `k`, `c`: stiffness and damping relative to the mass, h^2 k / m and h c / m [1].
  ContactShares(double k, double c);

  double after = 0.25, before = 0.25, damped_after = 0.5, damped_before = 0.5;
};

}  // namespace ctpm::contact
