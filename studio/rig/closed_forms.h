#pragma once

#include <functional>
#include <vector>

namespace ctpm::rig {

/// One contact site of the paper: a five-sphere line over one triple. Everything in this file is Bao & Wu, section 3,
/// in the paper's units: moduli in kPa/mm (the paper prints kPa), viscosity in kPa s/mm, lengths in mm, stress in kPa.
/// The network is compared with the closed forms and never computed from them.
struct Site {
  double spring = 0;       ///< K2 [kPa/mm], > 0
  double kelvin = 0;       ///< K1 [kPa/mm], > 0
  double constraint = 0;   ///< K' [kPa/mm], >= 0; 0 gives the TPM without constraint
  double viscosity = 0;    ///< v1 [kPa s/mm], >= 0
  double arm = 0;          ///< L, from A to C at rest [mm], > 0
  double ball_radius = 0;  ///< R of the probe, area S0 = pi R^2 [mm], > 0
};

double tan_theta(const Site& site, double depth);  ///< eps / L
double lambda(const Site& site, double depth);     ///< 2 K' (1 - cos theta) [kPa/mm]; Eq. 2
double p1(const Site& site);                       ///< v1 / (K1 + K2) [s]
double p2(const Site& site);                       ///< K1 K2 / (K1 + K2) [kPa/mm]
double p3(const Site& site);                       ///< v1 K2 / (K1 + K2) [kPa s/mm]

/// Static stress at a constant depth [kPa], Eq. 14: (P2 + lambda) eps / (1 + tan theta).
double slow_stress(const Site& site, double depth);

/// Stress at time `t` [s] after a step in depth [kPa], Eq. 11; Eq. 13 at t = 0.
double relaxation_stress(const Site& site, double depth, double t);

/// Depth at time `t` [s] after a step in stress [mm], Eq. 12 with lambda and theta at `depth`; Eq. 15 at t = 0. lambda
/// depends on the depth itself, so this holds only for a small step; creep() gives the whole curve.
double creep_depth(const Site& site, double stress, double depth, double t);

/// Static depth at a constant stress [mm]: the limit of Eq. 12, solved for the depth because lambda depends on it.
/// Deviation: Eq. 16 as printed has a first term, sigma0 (1 + tan theta) / (lambda + K2), that the limit does not have.
double slow_depth(const Site& site, double stress);

/// Force on the probe [N]: stress times S0 (Eq. 17; 1 kPa mm^2 = 1e-3 N).
double force_of_stress(const Site& site, double stress);

/// Static force of the paper's Table 1 [N]: with the constraint; divided by 1 + tan theta only for CTPM.
double table_force(const Site& site, double depth, bool with_softening);

/// The form of the law that is integrated over time.
enum class Law {
  eq_10,          ///< the paper's Eq. 10, whose derivation holds lambda and theta constant
  eqs_3_to_8,     ///< Eqs. 3-8 as printed, lambda without delay; static values equal Eq. 10, up to a few per cent
                  ///< of difference while lambda changes fast
  eqs_3_to_8_rig  ///< Eqs. 3-8 of all three triples of the rig (Fig. 3): the share P2 / K' of lambda comes from
                  ///< the stretch of A-B-C and E-D-C, which creep like the triple below C. Static values are
                  ///< equal; this is the network without mass
};

struct Sample {
  double time = 0;    ///< [s]
  double depth = 0;   ///< [mm]
  double stress = 0;  ///< [kPa]
};

/// Integrates the law for a given `depth(t)` [mm] with its rate `rate(t)` [mm/s]; samples every `interval` [s].
/// Fourth-order Runge-Kutta; the step is halved until two runs agree to 1e-8 of the largest stress. Kinks of the depth
/// must fall on samples.
std::vector<Sample> relaxation(const Site& site, const std::function<double(double)>& depth,
                               const std::function<double(double)>& rate, double duration, double interval,
                               Law law = Law::eq_10);

/// Integrates the law for a given `stress(t)` [kPa], as above, to 1e-8 of the largest depth.
std::vector<Sample> creep(const Site& site, const std::function<double(double)>& stress,
                          const std::function<double(double)>& rate, double duration, double interval,
                          Law law = Law::eq_10);

}  // namespace ctpm::rig
