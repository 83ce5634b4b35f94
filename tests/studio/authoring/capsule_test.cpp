// The tension that an organ's surface has in the body.

#include <gtest/gtest.h>

#include <cmath>

#include "studio/authoring/capsule.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

constexpr double kRadius = 0.05, kSpacing = 0.01;

/// A ball of spheres 10 mm apart within the octahedron of the same volume as a sphere of 50 mm.
FilledOrgan round_organ() {
  FilledOrgan organ;
  organ.spacing = kSpacing, organ.sphere_radius = kSpacing / 3;
  const double reach = kRadius * std::cbrt(M_PI);  // an octahedron has the volume 4/3 reach^3
  organ.surface.vertex = {{reach, 0, 0}, {-reach, 0, 0}, {0, reach, 0}, {0, -reach, 0}, {0, 0, reach}, {0, 0, -reach}};
  organ.surface.triangle = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  organ.depth = {-0.002, 0.008, 0.02};
  return organ;
}

scenes::MaterialSpec preset(const char* name, double scale) {
  scenes::MaterialSpec material;
  material.preset = name, material.stiffness_scale = scale;
  return material;
}

TEST(Capsule, OfALiverHoldsThePressureOfLaplacesLaw) {
  const std::optional<scenes::LayerSpec> layer = authoring::capsule_of(preset("liver", 0.8), round_organ());
  ASSERT_TRUE(layer);
  EXPECT_EQ(layer->to_depth, kSpacing);
  EXPECT_EQ(layer->material.preset, "liver");
  EXPECT_EQ(layer->material.stiffness_scale, 0.8);
  // The paper's liver: K1 = K2 = 15 kPa/mm in series, R = 2 mm, s = 12 mm; Young's modulus of the lattice 2.5 K S0 / s.
  const double modulus = 0.8 * 2.5 * 7.5e6 * M_PI * 4e-6 / 12e-3;
  const double tension =
      modulus * kSpacing * *layer->material.prestrain / (1 - 0.25);  // of a sheet, in both directions
  EXPECT_NEAR(2 * tension / kRadius, 930, 10);
}

TEST(Capsule, OfSkinHasTheStrainThatExcisedSkinLoses) {
  const std::optional<scenes::LayerSpec> layer = authoring::capsule_of(preset("skin", 1), round_organ());
  ASSERT_TRUE(layer);
  EXPECT_NEAR((1 - *layer->material.prestrain) * (1 - *layer->material.prestrain), 1 - 0.33, 0.005);
}

TEST(Capsule, IsLeftOutWhereNothingIsKnownOrTheOrganHasNoInside) {
  EXPECT_FALSE(authoring::capsule_of(preset("spleen", 1), round_organ()));
  FilledOrgan thin = round_organ();
  thin.depth = {0.001, 0.002};
  EXPECT_FALSE(authoring::capsule_of(preset("liver", 1), thin));
}

}  // namespace
}  // namespace ctpm
