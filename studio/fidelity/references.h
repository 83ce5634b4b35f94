#pragma once

// Reference values that do not come from this project's code. tests/references/ holds the scripts that made them.
namespace ctpm::fidelity {

/// A number from outside, and where it comes from.
struct Reference {
  double value;
  const char* source;
};

// The paper's liver at rest: k = K1 S0 = 15 kPa/mm pi (2 mm)^2 = 188.5 N/m an edge at a spacing of 12 mm.
inline constexpr double kYoung = 39270;           ///< Young's modulus, 2.5 k / s [Pa]
inline constexpr double kPoisson = 0.25;          ///< Poisson's ratio of the lattice [1]
inline constexpr double kRelaxation = 1.0 / 6.0;  ///< tau = v1 / (K1 + K2), with G(t) = G(inf) (1 + exp(-t / tau)) [s]

/// Force of a bar of 48 x 48 mm that is 1 % longer [N].
inline constexpr Reference kBarForce{0.9047808, "closed form: E A strain"};

/// Sag of the end of a beam 24 x 24 x 120 mm under its own weight at 0.0981 m/s^2, 1060 kg/m^3, all its material
/// clamped over the first 12 mm [m]. Elements of 6 mm give 0.969448 mm, of 4 mm 0.970410 mm, of 2 mm this.
inline constexpr Reference kCantileverSag{0.971209e-3, "CalculiX 2.20, C3D20R of 2 mm"};
inline constexpr double kCantileverSagOnCoarseMesh = 0.970410e-3;  ///< elements of 4 mm [m]

/// Ramps of a ball that enters tissue evenly and then stays.
struct Ramp {
  double time;      ///< [s]
  Reference ratio;  ///< force at the end of the ramp over the final force [1]
};
inline constexpr const char* kLeeRadok = "Lee & Radok 1960";
inline constexpr Ramp kRamps[] = {
    {0.005, {1.988102175, kLeeRadok}}, {0.05, {1.889635743, kLeeRadok}}, {0.5, {1.394894221, kLeeRadok}}};

/// Force of a block 96 x 96 x 60 mm, bottom held, that a rigid ball of 20 mm presses without friction.
struct Indentation {
  double depth;      ///< [m]
  Reference force;   ///< geometrically linear finite elements [N]
  double on_coarse;  ///< the same with elements of 2.4 mm [N]
  double svk;        ///< with large strains of St. Venant and Kirchhoff's law, which is softer in compression [N]
  double hertz;      ///< closed form of a half space [N]
};
extern const Indentation kIndentations[3];

}  // namespace ctpm::fidelity
