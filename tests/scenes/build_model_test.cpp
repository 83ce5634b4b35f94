#include "scenes/build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/network/network.h"
#include "scenes/presets.h"
#include "scenes/scene_file.h"

namespace ctpm {
namespace {

/// A scene of a liver block of 3 x 3 x 3 spheres, 12 mm apart, with more keys of the organ and of the scene.
scenes::SceneSpec block_scene(const std::string& more_of_organ = "", const std::string& more = "") {
  const Result<scenes::SceneText> scene = scenes::read_scene(
      R"({"format": "ctpm-scene", "version": 1, "name": "block", "organs": [{"name": "block", "rig": {"block": [3, 3, 3]},
          "material": {"preset": "liver"})" +
          more_of_organ + "}]" + more + "}",
      "block.json");
  if (!scene) {
    ADD_FAILURE() << to_string(scene.errors().front());
    return {};
  }
  return scene->spec;
}

scenes::BuiltScene build(const scenes::SceneSpec& scene) {
  std::vector<FilledOrgan> organs;
  for (const scenes::OrganSpec& organ : scene.organs) organs.push_back(scenes::fill_rig(organ));
  Result<scenes::BuiltScene> built = scenes::build_model(scene, organs);
  if (!built) {
    ADD_FAILURE() << to_string(built.errors().front());
    return {};
  }
  return std::move(*built);
}

Errors errors_of_build(const scenes::SceneSpec& scene) {
  std::vector<FilledOrgan> organs;
  for (const scenes::OrganSpec& organ : scene.organs) organs.push_back(scenes::fill_rig(organ));
  const Result<scenes::BuiltScene> built = scenes::build_model(scene, organs);
  return built ? Errors{} : built.errors();
}

const std::string kBall = R"(, "tools": [{"name": "ball", "kind": "ball", "radius_mm": 6}])";

TEST(FillRig, ABlockIsCentredOverTheOriginWithLayersFromItsFaces) {
  const scenes::SceneSpec scene = block_scene();
  const FilledOrgan organ = scenes::fill_rig(scene.organs[0]);
  ASSERT_EQ(organ.centre.size(), 27u);
  EXPECT_DOUBLE_EQ(organ.spacing, 0.012);
  Vec3 sum;
  for (const Vec3 centre : organ.centre) sum += centre;
  EXPECT_NEAR(norm(sum / 27 - Vec3{0, 0, 0.012}), 0, 1e-15);
  EXPECT_EQ(std::count(organ.layer.begin(), organ.layer.end(), 1), 26);
  EXPECT_EQ(organ.layer[13], 2);
  EXPECT_DOUBLE_EQ(organ.depth[13], 0.018);
  EXPECT_TRUE(std::is_sorted(organ.cell.begin(), organ.cell.end(), [](const auto& a, const auto& b) {
    return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]);
  }));
}

TEST(BuildModel, LoadsActOnTheNearestSphereWithTheirTimes) {
  const scenes::BuiltScene built = build(block_scene(
      "", R"(, "loads": [{"at_mm": [1, -1, 30], "force_n": [0.1, 0, -0.13], "start_s": 0.5, "ramp_s": 0.25}])"));
  const Loads& loads = built.model.loads;
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_EQ(built.model.rest_position[std::size_t(loads.sphere[0])], (Vec3{0, 0, 0.024}));
  EXPECT_EQ(loads.force[0], (Vec3{0.1, 0, -0.13}));
  EXPECT_EQ(loads.start[0], 0.5);
  EXPECT_EQ(loads.ramp[0], 0.25);
}

TEST(BuildModel, ProbesAndPinsTakeTheNearestSphereTheFirstOfSeveral) {
  const scenes::BuiltScene built =
      build(block_scene("", R"(, "probes": [{"name": "p", "at_mm": [12, 12, 0]}, {"name": "q", "at_mm": [6, 0, 0]}],
      "tools": [{"name": "pin", "kind": "pin", "holds_mm": [-13, 0, 25]}])"));
  ASSERT_EQ(built.probe_sphere.size(), 2u);
  EXPECT_EQ(built.probe_sphere[0], 8);
  EXPECT_EQ(built.probe_sphere[1], 4);  // halfway between sphere 4 and 5
  ASSERT_EQ(built.model.tools.size(), 1u);
  EXPECT_EQ(built.model.tools[0].kind, ToolKind::pin);
  EXPECT_EQ(built.model.tools[0].sphere, 21);
  EXPECT_EQ(built.model.contact_k, 0);  // nothing presses
}

TEST(BuildModel, AnchorsAreHeldAndCounted) {
  const scenes::BuiltScene built = build(block_scene(R"(, "anchors": [{"lowest_mm": 2}])"));
  EXPECT_EQ(built.anchored_count, std::vector<std::int32_t>{9});
  for (std::size_t i = 0; i < 27; ++i) EXPECT_EQ(built.model.held_axes[i], i < 9 ? kAnchored : 0);
}

TEST(BuildModel, GuidesHoldTheAxesThatTheyName) {
  scenes::SceneSpec scene = block_scene();
  scene.organs[0].rig->guides = {{{1, 1, 1}, "x"}, {{0, 2, 2}, "zy"}};
  const scenes::BuiltScene built = build(scene);
  EXPECT_EQ(built.model.held_axes[13], 1);
  EXPECT_EQ(built.model.held_axes[24], 2 | 4);
  EXPECT_EQ(std::count(built.model.held_axes.begin(), built.model.held_axes.end(), 0), 25);
}

TEST(BuildModel, SolverSettingsAreTheScenesOrElseThoseOfTheCore) {
  const scenes::BuiltScene plain = build(block_scene());
  const SolverSettings standard;
  EXPECT_EQ(plain.model.solver.tolerance, standard.tolerance);
  EXPECT_EQ(plain.model.solver.velocity_floor, standard.velocity_floor);
  EXPECT_EQ(plain.model.solver.velocity_enough, 2e-6);
  EXPECT_EQ(plain.model.solver.max_iterations, standard.max_iterations);
  EXPECT_EQ(plain.model.solver.substeps, standard.substeps);
  EXPECT_EQ(plain.model.solver.sleep_bound, 0);
  const scenes::BuiltScene own = build(
      block_scene("",
                  R"(, "solver": {"tolerance": 1e-7, "velocity_floor_mm_per_s": 2, "max_iterations": 77, "substeps": 3,
                      "velocity_enough_mm_per_s": 4, "sleep_below_mm_per_s": 0.5},
      "tick_s": 0.002, "gravity_m_per_s2": [1, 2, 3])"));
  EXPECT_EQ(own.model.solver.tolerance, 1e-7);
  EXPECT_EQ(own.model.solver.velocity_floor, 0.002);
  EXPECT_EQ(own.model.solver.velocity_enough, 0.004);
  EXPECT_EQ(own.model.solver.max_iterations, 77);
  EXPECT_EQ(own.model.solver.substeps, 3);
  EXPECT_EQ(own.model.solver.sleep_bound, 0.0005);
  EXPECT_EQ(own.model.tick, 0.002);
  EXPECT_EQ(own.model.gravity, (Vec3{1, 2, 3}));
  const scenes::BuiltScene strict = build(block_scene("", R"(, "solver": {"velocity_floor_mm_per_s": 1e-6})"));
  EXPECT_EQ(strict.model.solver.velocity_enough, 0) << "a scene's own floor holds after an iteration, too";
}

TEST(BuildModel, AToolIsTwentyTimesAsStiffAsTheStiffestEdgeUnlessTheSceneSaysMore) {
  const double area = network::edge_area(scenes::find_preset("liver")->material, 0.012);
  EXPECT_NEAR(build(block_scene("", kBall)).model.contact_k, 20 * 15e6 * area, 1e-9);
  EXPECT_EQ(build(block_scene("", kBall)).model.contact_friction, 0.3);
  EXPECT_NEAR(build(block_scene(R"(, "model": "tpm")", kBall)).model.contact_k, 20 * 15e6 * area, 1e-9);
  const scenes::BuiltScene own =
      build(block_scene("", kBall + R"(, "contact_stiffness_n_per_m": 1234, "contact_friction": 0.1)"));
  EXPECT_EQ(own.model.contact_k, 1234);
  EXPECT_EQ(own.model.contact_friction, 0.1);
  EXPECT_EQ(own.model.tools.at(0).radius, 0.006);
}

TEST(BuildModel, TheLawsOfContactAreTheScenesOrElseThoseOfTheCore) {
  const std::string kTools = R"(, "tools": [{"name": "ball", "kind": "ball", "radius_mm": 6},
      {"name": "knife", "kind": "scalpel", "blade_length_mm": 50)";
  const scenes::BuiltScene plain = build(block_scene("", kTools + R"(}], "lips_meet": true)"));
  const Model standard;
  EXPECT_EQ(plain.model.contact_damping, standard.contact_damping);
  EXPECT_EQ(plain.model.cut_face_stiffening, standard.cut_face_stiffening);
  const Tool blade = plain.model.tools.at(1), other;
  EXPECT_EQ(blade.blade_reach, other.blade_reach);
  EXPECT_EQ(blade.flank_height, other.flank_height);
  EXPECT_EQ(blade.blade_thickness, 0.0004) << "Tool's own default is that of old sessions";

  const scenes::BuiltScene own =
      build(block_scene("", kTools + R"(, "blade_reach_mm": 4, "flank_height_mm": 7, "blade_thickness_mm": 0.25}],
      "lips_meet": true, "contact_damping_s_per_m": 20, "cut_face_stiffening": 3)"));
  EXPECT_EQ(own.model.contact_damping, 20);
  EXPECT_EQ(own.model.cut_face_stiffening, 3);
  EXPECT_EQ(own.model.tools.at(1).blade_reach, 0.004);
  EXPECT_EQ(own.model.tools.at(1).flank_height, 0.007);
  EXPECT_EQ(own.model.tools.at(1).blade_thickness, 0.00025);
}

TEST(BuildModel, ObstaclesLieWhereTheSceneSaysAndTouchWithItsFriction) {
  const scenes::BuiltScene built = build(block_scene("", R"(, "contact_friction": 0.4, "obstacles": [
      {"name": "slope", "plane": {"point_mm": [1, 2, 3], "normal": [0, 3, 4]}},
      {"name": "ceiling", "plane": {"point_mm": [0, 0, 500], "normal": [0, 0, -2]}},
      {"name": "table", "box": {"min_mm": [-10, -20, -40], "max_mm": [10, 20, -30]}}])"));
  const std::vector<Obstacle>& obstacles = built.model.obstacles;
  ASSERT_EQ(obstacles.size(), 3u);
  EXPECT_EQ(obstacles[0].kind, ObstacleKind::plane);
  EXPECT_EQ(obstacles[0].position, (Vec3{0.001, 0.002, 0.003}));
  const Vec3 up{0, 0, 1}, normal = rotate(obstacles[0].world_from_obstacle, up);
  EXPECT_NEAR(norm(normal - Vec3{0, 0.6, 0.8}), 0, 1e-15);
  EXPECT_NEAR(norm(rotate(obstacles[1].world_from_obstacle, up) + up), 0, 1e-15);
  EXPECT_EQ(obstacles[2].kind, ObstacleKind::box);
  EXPECT_NEAR(norm(obstacles[2].position - Vec3{0, 0, -0.035}), 0, 1e-15);
  EXPECT_NEAR(norm(obstacles[2].half_size - Vec3{0.01, 0.02, 0.005}), 0, 1e-15);
  EXPECT_EQ(built.model.contact_friction, 0.4);
  EXPECT_GT(built.model.contact_k, 0) << "a rig touches with its spheres";
  EXPECT_FALSE(built.model.organs_meet);
  EXPECT_TRUE(build(block_scene()).model.obstacles.empty());
}

TEST(BuildModel, OrgansFromAMeshResistInversionAndRigsOnlyIfAsked) {
  EXPECT_EQ(build(block_scene("")).model.tissue_cells.size(), 0u);
  const scenes::BuiltScene asked = build(block_scene(R"(, "inversion_resistance": 4)"));
  ASSERT_GT(asked.model.tissue_cells.size(), 0u);
  const scenes::BuiltScene twice = build(block_scene(R"(, "inversion_resistance": 8)"));
  EXPECT_NEAR(twice.model.tissue_cells.k.at(0), 2 * asked.model.tissue_cells.k.at(0), 1e-12);

  scenes::OrganSpec organ;
  organ.mesh = "a.obj";
  EXPECT_EQ(scenes::inversion_resistance_of(organ), 10);
  organ.inversion_resistance = 0;
  EXPECT_EQ(scenes::inversion_resistance_of(organ), 0);
  scenes::OrganSpec rig;
  rig.rig.emplace();
  EXPECT_EQ(scenes::inversion_resistance_of(rig), 0);
}

TEST(BuildModel, TheOrgansKeysReachTheNetwork) {
  const scenes::BuiltScene ctpm = build(block_scene(R"(, "damage_depth_mm": 12)"));
  EXPECT_EQ(ctpm.model.organs.at(0).damage_depth, 0.012);
  EXPECT_EQ(ctpm.model.organs.at(0).name, "block");
  EXPECT_GT(ctpm.model.axial.size(), 0u);
  EXPECT_FALSE(ctpm.model.axial.c.empty());
  const scenes::BuiltScene springs = build(block_scene(R"(, "model": "mass-spring")"));
  EXPECT_TRUE(springs.model.axial.c.empty());
  EXPECT_EQ(build(block_scene(R"(, "model": "tpm")")).model.axial.internal_count(), springs.model.axial.size());
  EXPECT_GT(build(block_scene(R"(, "model": "angle-mass-spring")")).model.angle_springs.size(), 0u);
  EXPECT_LT(build(block_scene(R"(, "lattice": "cubic-6")")).model.axial.size(), ctpm.model.axial.size());
}

/// A block of 5 x 5 x 5 spheres, 6, 18 and 30 mm deep, with layers.
scenes::SceneSpec layered_scene(const std::string& layers) {
  scenes::SceneSpec scene = block_scene(R"(, "layers": [)" + layers + "]");
  scene.organs.at(0).rig->block = Vec3{5, 5, 5};
  return scene;
}

TEST(BuildModel, LayersHaveTheirOwnTissue) {
  const scenes::BuiltScene built = build(layered_scene(
      R"({"to_depth_mm": 12, "material": {"preset": "skin", "density_kg_per_m3": 1200}}, {"to_depth_mm": 20, "material": {"preset": "kidney", "density_kg_per_m3": 1100}})"));
  const double volume = 0.012 * 0.012 * 0.012;
  EXPECT_NEAR(built.model.mass[0], 1200 * volume, 1e-15);
  EXPECT_NEAR(built.model.mass[31], 1100 * volume, 1e-15);
  EXPECT_NEAR(built.model.mass[62], 1060 * volume, 1e-15);
  // Along the block's first line all five spheres are skin.
  EXPECT_NEAR(built.model.axial.k.at(0), 82e6 * network::edge_area(scenes::find_preset("skin")->material, 0.012), 1e-9);
}

TEST(BuildModel, ALayerDeeperThanTheOrganIsAnErrorAtItsPlace) {
  const Errors errors = errors_of_build(layered_scene(
      R"({"to_depth_mm": 12, "material": {"preset": "skin"}}, {"to_depth_mm": 31, "material": {"preset": "skin"}})"));
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(to_string(errors[0]),
            "/organs/0/layers/1/to_depth_mm: error: got 31 mm, which is deeper than the organ (its spheres "
            "lie 6 mm to 30 mm below its surface)");
}

TEST(BuildModel, ALayerThatHoldsNoSphereIsAnErrorAtItsPlace) {
  const Errors errors = errors_of_build(layered_scene(
      R"({"to_depth_mm": 6, "material": {"preset": "skin"}}, {"to_depth_mm": 12, "material": {"preset": "skin"}}, {"to_depth_mm": 17.9, "material": {"preset": "skin"}})"));
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(to_string(errors[0]),
            "/organs/0/layers/0/to_depth_mm: error: the layer from 0 mm to 6 mm holds no sphere (its spheres "
            "lie 6 mm to 30 mm below its surface)");
  EXPECT_EQ(errors[1].where, "/organs/0/layers/2/to_depth_mm");
}

TEST(BuildModel, SofteningCanBeLeftOut) {
  scenes::SceneSpec scene = block_scene();
  scene.organs[0].rig->block = Vec3{5, 5, 5};
  EXPECT_TRUE(build(scene).model.has_softening);
  scene.organs[0].softening = false;
  EXPECT_FALSE(build(scene).model.has_softening);
}

TEST(BuildModel, EveryProblemOfEveryOrganIsReportedAtItsOrgan) {
  scenes::SceneSpec scene = block_scene();
  scene.organs.push_back(scene.organs[0]);
  scene.organs[0].anchors.emplace_back().sphere = scenes::SphereRegion{{9, 9, 9}, 0.001};
  scene.organs[1].rig->block.reset();
  scene.organs[1].rig->cells = {{0, 0, 0}, {5, 0, 0}, {0, 7, 0}};
  const Errors errors = errors_of_build(scene);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0].where, "/organs/0/anchors/0");
  EXPECT_EQ(to_string(errors[1]),
            "/organs/1/rig/cells: error: no two of the 3 spheres are neighbours, so nothing joins them (neighbours "
            "differ by 1 along one axis or two)");
}

TEST(BuildModel, AMaterialThatTheNetworkRefusesIsPlacedAtItsOrgan) {
  scenes::SceneSpec scene = layered_scene(R"({"to_depth_mm": 12, "material": {"preset": "skin"}})");
  scene.organs[0].material.spring = -1.0;  // the reader would have refused both
  scene.organs[0].layers[0].material.kelvin = -1.0;
  const Errors errors = errors_of_build(scene);
  std::string all;
  for (const Error& error : errors) all += to_string(error) + "\n";
  EXPECT_NE(all.find("/organs/0: error: organ block: spring modulus K2: got -1"), std::string::npos) << all;
  EXPECT_NE(all.find("/organs/0: error: organ block, layer 0: Kelvin modulus K1: got -1"), std::string::npos) << all;
}

TEST(BuildModel, RefusesAnExplicitIntegratorThatCannotHoldItsStep) {
  const auto with_solver = [](const char* solver) {
    return errors_of_build(block_scene("", std::string(R"(, "solver": )") + solver));
  };
  const Errors errors = with_solver(R"({"integrator": "leapfrog"})");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].where, "/solver/integrator");
  EXPECT_NE(errors[0].message.find("substeps up to"), std::string::npos) << errors[0].message;
  EXPECT_TRUE(with_solver(R"({"integrator": "leapfrog", "substeps": 1000})").empty());
  EXPECT_TRUE(with_solver(R"({"integrator": "sdirk2"})").empty());
}

}  // namespace
}  // namespace ctpm
