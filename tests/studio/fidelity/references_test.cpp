// The stored references are those of their sources, and the material is the shipped liver's.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/network/network.h"
#include "scenes/presets.h"
#include "studio/fidelity/references.h"

namespace ctpm::fidelity {
namespace {

constexpr double kDigits = 1e-8;  // relative: the stored values have nine digits

TEST(References, TheMaterialIsThePresetsLiver) {
  const network::Material& liver = scenes::find_preset("liver")->material;
  const double spacing = 12e-3, k = liver.kelvin * network::edge_area(liver, spacing);
  EXPECT_NEAR(2.5 * k / spacing, kYoung, 1) << "the cubic-18 lattice";
  EXPECT_NEAR(liver.viscosity / (liver.spring + liver.kelvin), kRelaxation, 1e-12);
  EXPECT_NEAR(liver.spring * liver.kelvin / (liver.spring + liver.kelvin), 0.5 * liver.spring, 1e-6)
      << "at rest a triple has half of its first stiffness: G(t) / G(inf) = 1 + exp(-t / tau)";
}

TEST(References, TheBarIsStressTimesArea) {
  EXPECT_NEAR(kBarForce.value, kYoung * 0.01 * 48e-3 * 48e-3, kDigits * kBarForce.value);
}

/// Hertz's pressure p0 sqrt(1 - (r / a)^2) under the ball, summed in rings of equal width of sin(u) = r / a.
double hertz_by_pressure(double radius, double depth) {
  const double a = std::sqrt(radius * depth), stiffness = kYoung / (1 - kPoisson * kPoisson);
  const double peak = 2 * stiffness * a / (std::numbers::pi * radius);
  constexpr int kRings = 20000;
  double force = 0;
  for (int i = 0; i < kRings; ++i) {
    const double u = (i + 0.5) * 0.5 * std::numbers::pi / kRings, r = a * std::sin(u);
    force += peak * std::cos(u) * 2 * std::numbers::pi * r * a * std::cos(u) * 0.5 * std::numbers::pi / kRings;
  }
  return force;
}

TEST(References, HertzIsTheSumOfItsPressure) {
  for (const Indentation& i : kIndentations)
    EXPECT_NEAR(i.hertz, hertz_by_pressure(20e-3, i.depth), kDigits * i.hertz) << 1e3 * i.depth << " mm";
}

/// The superposition of small steps of depth^1.5, each relaxing from its own time.
double lee_radok_by_steps(double ramp) {
  constexpr int kSteps = 200000;
  double force = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double from = std::pow(double(i) / kSteps, 1.5), to = std::pow(double(i + 1) / kSteps, 1.5);
    const double age = ramp * (1 - (i + 0.5) / kSteps);
    force += (to - from) * (1 + std::exp(-age / kRelaxation));
  }
  return force;
}

TEST(References, LeeAndRadokIsTheSuperpositionOfSteps) {
  for (const Ramp& ramp : kRamps)
    EXPECT_NEAR(ramp.ratio.value, lee_radok_by_steps(ramp.time), kDigits) << 1e3 * ramp.time << " ms";
}

TEST(References, FiniteElementsChangeLittleFromMeshToMesh) {
  EXPECT_NEAR(kCantileverSagOnCoarseMesh / kCantileverSag.value, 1, 2e-3);
  for (const Indentation& i : kIndentations)
    EXPECT_NEAR(i.on_coarse / i.force.value, 1, 0.03) << 1e3 * i.depth << " mm";
}

TEST(References, TheBlockIsStifferThanAHalfSpaceAndTheBeamSagsMoreThanBendingAlone) {
  for (const Indentation& i : kIndentations) EXPECT_GT(i.force.value, i.hertz);
  const double side = 24e-3, free = 108e-3, load = 1060 * 0.0981 * side * side;
  const double bending = load * std::pow(free, 4) / (8 * kYoung * std::pow(side, 4) / 12);
  const double shear = load * free * free / 2 / (5.0 / 6.0 * kYoung / 2.5 * side * side);
  EXPECT_GT(kCantileverSag.value, bending);
  EXPECT_NEAR(kCantileverSag.value, bending + shear, 0.02 * kCantileverSag.value) << "Timoshenko's beam";
}

}  // namespace
}  // namespace ctpm::fidelity
