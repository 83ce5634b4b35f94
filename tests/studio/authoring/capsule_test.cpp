// The tension that an organ's surface has in the body.

#include <gtest/gtest.h>

#include <cmath>

#include "core/surface/surface.h"
#include "importers/topology.h"
#include "scenes/build_model.h"
#include "studio/authoring/capsule.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/standing.h"

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
  const std::optional<authoring::Tension> tension = authoring::tension_of(preset("liver", 0.8), round_organ());
  ASSERT_TRUE(tension);
  EXPECT_EQ(tension->capsule.to_depth, kSpacing);
  EXPECT_EQ(tension->capsule.material.preset, "liver");
  EXPECT_EQ(tension->capsule.material.stiffness_scale, 0.8);
  // The paper's liver: K1 = K2 = 15 kPa/mm in series, R = 2 mm, s = 12 mm; Young's modulus of the lattice 2.5 K S0 / s.
  const double modulus = 0.8 * 2.5 * 7.5e6 * M_PI * 4e-6 / 12e-3;
  const double per_length = modulus * kSpacing * tension->strain / (1 - 0.25);  // of a sheet, in both directions
  EXPECT_NEAR(2 * per_length / kRadius, 930, 10);
}

TEST(Capsule, PressesWhatIsInsideSoThatTheOrganKeepsItsSize) {
  const std::optional<authoring::Tension> tension = authoring::tension_of(preset("liver", 0.8), round_organ());
  ASSERT_TRUE(tension);
  const double outer = *tension->capsule.material.prestrain;
  // Two of three spheres are in the capsule.
  EXPECT_NEAR(2 * outer + tension->inside, 0, 0.1 * tension->strain);
  EXPECT_NEAR((1 - outer) / (1 - tension->inside), 1 - tension->strain, 2e-3);
}

TEST(Capsule, OfSkinHasTheStrainThatExcisedSkinLoses) {
  const std::optional<authoring::Tension> tension = authoring::tension_of(preset("skin", 1), round_organ());
  ASSERT_TRUE(tension);
  EXPECT_NEAR((1 - tension->strain) * (1 - tension->strain), 1 - 0.33, 0.005);
}

TEST(Capsule, IsLeftOutWhereNothingIsKnownOrTheOrganHasNoInside) {
  EXPECT_FALSE(authoring::tension_of(preset("spleen", 1), round_organ()));
  FilledOrgan thin = round_organ();
  thin.depth = {0.001, 0.002};
  EXPECT_FALSE(authoring::tension_of(preset("liver", 1), thin));
}

/// Volume of a liver's surface once it has settled without gravity, over that of the mesh.
double settled_size(bool is_pressed_inside) {
  Result<loading::LoadedScene> loaded = loading::load_whole_scene(std::string(CTPM_SOURCE_DIR) + "/scenes/liver.json");
  EXPECT_TRUE(loaded);
  scenes::SceneSpec scene = loaded->scene.spec;
  scene.gravity = {}, scene.settle = 5;
  scenes::OrganSpec& organ = scene.organs[0];
  organ.anchors.clear(), organ.layers.clear();
  const std::optional<authoring::Tension> tension = authoring::tension_of(organ.material, loaded->organs[0]);
  EXPECT_TRUE(tension);
  organ.layers = {tension->capsule};
  if (is_pressed_inside)
    organ.material.prestrain = tension->inside;
  else
    organ.material.prestrain = 0, organ.layers[0].material.prestrain = tension->strain;
  for (scenes::MaterialSpec* material : {&organ.material, &organ.layers[0].material}) material->viscosity = 0;
  const Result<scenes::BuiltScene> built = scenes::build_model(scene, std::span(&loaded->organs[0], 1));
  EXPECT_TRUE(built);
  const auto standing = loading::settle_scene(scene, built->model);
  const auto volume = [&](const State& state) {
    std::vector<Vec3> vertex;
    surface::deform_surface(built->model.surfaces[0], state.position, 0, vertex);
    return importers::signed_volume(vertex, built->model.surfaces[0].triangle, vertex[0]);
  };
  return volume(standing->state) / volume(rest_state(built->model));
}

TEST(Capsule, LeavesASettledLiverAsLargeAsItsMesh) {
  EXPECT_NEAR(settled_size(true), 1, 0.05);
  EXPECT_LT(settled_size(false), 0.9) << "what the tension alone does";
}

}  // namespace
}  // namespace ctpm
