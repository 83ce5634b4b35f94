// The stiffness scales of the shipped scenes, and how they are fitted.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "core/stepping/step.h"
#include "scenes/presets.h"
#include "studio/authoring/fit_stiffness.h"
#include "studio/loading/loaded_scene.h"
#include "studio/rig/site.h"

namespace ctpm {
namespace {

const std::string kScenes = std::string(CTPM_SOURCE_DIR) + "/scenes";

class ShippedOrgan : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedOrgan, HoldsTheScaleThatMeetsTable1AtTwelveMillimetres) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(kScenes + "/" + GetParam() + ".json");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  const scenes::OrganSpec& organ = scene->scene.spec.organs[0];
  const Result<authoring::StiffnessFit> fit = authoring::fit_stiffness(scene->scene.spec, 0, scene->organs[0]);
  ASSERT_TRUE(fit) << to_string(fit.errors().front());
  // Fitting what is fitted already changes nothing.
  EXPECT_NEAR(fit->factor, 1, 0.01);
  ASSERT_TRUE(organ.material.fitted_for);
  const scenes::FittedForSpec& stored = *organ.material.fitted_for;
  EXPECT_NEAR(norm(stored.place - fit->fitted_for.place), 0, 0.1e-3);
  EXPECT_NEAR(stored.force, rig::table_force(rig::site_of(organ), 12, true), 0.01 * stored.force);
  ASSERT_EQ(fit->rows.size(), 6u);
  EXPECT_NEAR(fit->rows.back().error(), 0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Fit, ShippedOrgan, ::testing::Values("liver", "kidney", "kidney-capsule", "skin"));

/// Force on a ball that presses the top of an organ by 4 mm, without gravity [N].
double force_at_four_millimetres(const loading::LoadedScene& scene,
                                 const std::function<void(scenes::SceneSpec&)>& change) {
  const Result<scenes::BuiltScene> built =
      loading::build_changed(scene, [&](scenes::SceneSpec& s) { s.gravity = {}, change(s); });
  CTPM_CHECK(bool(built), "a shipped scene is valid");
  const Model& model = built->model;
  Vec3 top = scene.scene.spec.organs[0].material.fitted_for->place;
  const auto c = std::size_t(scenes::nearest_sphere(model, top));
  Inputs inputs;
  inputs.tool = 0;
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  stepping::StepReport report;
  for (int tick = 0; tick <= 1000; ++tick) {
    inputs.position = model.rest_position[c] +
                      Vec3{0, 0, model.tools[0].radius + model.contact_radius[c] - 4e-3 * std::min(1.0, tick / 400.0)};
    report = stepper.step(state, inputs);
  }
  return report.tool_force.z;
}

TEST(ShippedCapsule, IsItsOwnTissueAndMakesTheKidneyStiffer) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(kScenes + "/kidney-capsule.json");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  const std::vector<double>& depth = scene->organs[0].depth;
  const double end = scene->scene.spec.organs[0].layers.at(0).to_depth;
  const auto capsule = std::count_if(depth.begin(), depth.end(), [&](double d) { return d < end; });
  EXPECT_GT(capsule, 100);
  EXPECT_GT(std::ptrdiff_t(depth.size()) - capsule, 100);
  const double whole = force_at_four_millimetres(*scene, [](scenes::SceneSpec&) {});
  const double bare = force_at_four_millimetres(*scene, [](scenes::SceneSpec& s) { s.organs[0].layers.clear(); });
  const double solid = force_at_four_millimetres(
      *scene, [](scenes::SceneSpec& s) { s.organs[0].material = s.organs[0].layers[0].material; });
  EXPECT_GT(whole, 1.2 * bare);
  EXPECT_LT(whole, solid);
}

TEST(Fit, FindsTheFactorWhateverTheScaleWas) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(kScenes + "/skin.json");
  ASSERT_TRUE(scene);
  scenes::SceneSpec spec = scene->scene.spec;
  const double fitted = *spec.organs[0].material.stiffness_scale;
  spec.organs[0].material.stiffness_scale = 5 * fitted;
  const Result<authoring::StiffnessFit> fit = authoring::fit_stiffness(spec, 0, scene->organs[0]);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->factor, 0.2, 0.002);
  authoring::apply_fit(spec.organs[0], *fit);
  EXPECT_NEAR(*spec.organs[0].material.stiffness_scale, fitted, 0.01 * fitted);
  const Result<scenes::SceneText> again = scenes::read_scene(scenes::write_scene(spec), "fitted.json");
  ASSERT_TRUE(again) << to_string(again.errors().front());
  EXPECT_TRUE(again->spec == spec);
}

TEST(Fit, AnOrganThatLiesLooseIsHeldMeanwhile) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(kScenes + "/kidney-on-table.json");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  scenes::SceneSpec spec = scene->scene.spec;
  ASSERT_TRUE(spec.organs[0].anchors.empty());
  const Result<authoring::StiffnessFit> fit = authoring::fit_stiffness(spec, 0, scene->organs[0]);
  ASSERT_TRUE(fit) << to_string(fit.errors().front());
  EXPECT_NEAR(fit->factor, 1, 0.05) << "it has the scale of the same kidney that is held";
}

TEST(Fit, DoesNotDependOnWhereDownIs) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "ctpm_fit_down";
  std::filesystem::create_directories(folder / "organs");
  std::filesystem::copy_file(kScenes + "/organs/kidney.obj", folder / "organs/kidney.obj",
                             std::filesystem::copy_options::overwrite_existing);
  std::stringstream read;
  read << std::ifstream(kScenes + "/kidney.json").rdbuf();
  std::string text = read.str();
  const auto add_after = [&](const std::string& what, const std::string& added) {
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.insert(at + what.size(), added);
  };
  add_after("\"version\": 1,", "\"gravity_m_per_s2\": [0, -9.81, 0],");
  add_after("\"model\": \"ctpm\",", "\"turn_deg\": [-90, 0, 0],");
  std::ofstream(folder / "scene.json") << text;
  const Result<loading::LoadedScene> scene = loading::load_whole_scene((folder / "scene.json").string());
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  ASSERT_TRUE(scene->scene.spec.organs[0].anchors.at(0).lowest);
  const Result<authoring::StiffnessFit> fit = authoring::fit_stiffness(scene->scene.spec, 0, scene->organs[0]);
  ASSERT_TRUE(fit) << to_string(fit.errors().front());
  EXPECT_NEAR(fit->factor, 1, 0.01) << "the lattice lies in it as before";
}

TEST(Fit, AnOrganThatCannotMoveIsToldSo) {
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(kScenes + "/paper/block-liver.json");
  ASSERT_TRUE(scene);
  scenes::SceneSpec spec = scene->scene.spec;
  spec.organs[0].anchors[0].lowest = 1.0;
  const Result<authoring::StiffnessFit> fit = authoring::fit_stiffness(spec, 0, scene->organs[0]);
  ASSERT_FALSE(fit);
  EXPECT_NE(to_string(fit.errors().front()).find("no outermost sphere can move"), std::string::npos);
}

}  // namespace
}  // namespace ctpm
