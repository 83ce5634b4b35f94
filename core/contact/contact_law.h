#pragma once

#include "core/model/model.h"

namespace ctpm::contact {

/// Damping along the normal [N s/m] of a contact of stiffness `k` [N/m] with a sphere of `mass` [kg] at `penetration`
/// [m]. `hunt_crossley` [s/m] is c in the law k p (1 + c p') of Hunt & Crossley, "Coefficient of restitution
/// interpreted as damping in vibroimpact" (1975). The result never exceeds critical damping.
double contact_damping(double hunt_crossley, double k, double mass, double penetration);

/// Tissue under one point of a surface that a tool dents: a three-parameter model, a spring K2 in series with a Kelvin
/// unit, over a step in which the Kelvin unit follows by backward Euler. The lattice gives way to a pressure over
/// lengths of its spacing; the dent is what it does not resolve.
struct Foundation {
  double k = 0;        ///< decrease of the force per decrease of the dent in this step [N/m], >= 0
  double relaxed = 0;  ///< decrease of the force per Kelvin part of the dent at the start [N/m], >= 0
  double keeps = 0;    ///< what stays of that Kelvin part at the end of the step [1]
  double follows = 0;  ///< share of the dent that it takes over in the step [1]

  Foundation() = default;
  /// `static_k`: stiffness at rest [N/m]; `h`: length of the step [s].
  Foundation(const OrganRange& organ, double static_k, double h);

  double force(double dent, double kelvin_dent) const { return k * dent - relaxed * kelvin_dent; }
  double kelvin_after(double dent, double kelvin_dent) const { return keeps * kelvin_dent + follows * dent; }
};

/// Pressure per depth of a dent [Pa/m] of tissue with `modulus` E [Pa] (Poisson's ratio 1/4) where a tool touches an
/// area of radius `a` [m], > 0, and the surface resolves no length below `unresolved` l [m], > 0:
///   0.6 E / (1 - nu^2) / a (1 + x / 2 + 0.85 x^3 / (x + 1.5)), x = a / l.
/// A ball on a half space whose point loads are blurred by a Gaussian, so that a load moves its own place as in l,
/// meets Hertz's force with it, 4/3 E / (1 - nu^2) sqrt(R) d^1.5 (Johnson, "Contact mechanics", 1985, ch. 4): exactly
/// where a << l, since the ball touches where it overlaps, a^2 = 2 R d; within 3 % up to x = 4
/// (tests/references/dent.py).
double dent_stiffness(double modulus, double a, double unresolved);

/// Weights of the velocities after and before an explicit step in the contact force at its middle. The defaults are
/// second order: 0.25 each in the penetration (Newmark's average acceleration) and 0.5 each in the damping. Where the
/// step is too long to resolve the contact, the velocity after it weighs more, so that the contact does not ring.
struct ContactShares {
  /// `k`, `c`: stiffness and damping relative to the mass, h^2 k / m and h c / m [1].
  ContactShares(double k, double c);

  double after = 0.25, before = 0.25, damped_after = 0.5, damped_before = 0.5;
};

}  // namespace ctpm::contact
