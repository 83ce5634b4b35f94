// The script that an import writes cuts no deeper than the organ bears.

#include "studio/authoring/script_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "studio/authoring/import_scene.h"
#include "studio/loading/loaded_scene.h"
#include "studio/loading/script_trial.h"
#include "studio/loading/standing.h"
#include "zoo.h"

namespace ctpm {
namespace {

/// A lump of tissue as it was imported.
class Lump {
 public:
  /// Of a mesh; the files' names are the lump's own.
  Lump(const importers::RawMesh& mesh, authoring::ImportRequest request) {
    folder_ = ::testing::TempDir() + "ctpm-script-choice-XXXXXX";
    EXPECT_NE(mkdtemp(folder_.data()), nullptr);
    request.mesh = folder_ + "/lump.obj", request.scene = folder_ + "/scene.json", request.stiffness_scale = 1;
    std::ofstream(request.mesh) << zoo::to_obj_text(mesh);
    const Result<authoring::ImportOutcome> outcome = authoring::import_scene(request);
    EXPECT_TRUE(outcome) << (outcome ? "" : outcome.errors().front().message);
    for (const importers::Finding& finding : outcome->organs.at(0).report.findings) found_.push_back(finding.code);
    Result<loading::LoadedScene> loaded = loading::load_whole_scene(request.scene);
    EXPECT_TRUE(loaded);
    scene_ = *std::move(loaded);
    std::ifstream file(outcome->script_file);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    script_ = *scenes::read_script_for(text, outcome->script_file, scene_.built.model);
  }
  ~Lump() { std::filesystem::remove_all(folder_); }

  bool was_found(const std::string& kind) const {
    return std::find(found_.begin(), found_.end(), kind) != found_.end();
  }

  /// Of the script's cut [m].
  double cut_depth() const {
    Vec3 from;
    for (const scenes::ScriptStep& step : script_.steps) {
      if (step.take) from = step.take->at;
      if (step.cut) return from.z - step.cut->path.front().z - 0.020;  // it appears 20 mm above the top
    }
    return 0;
  }
  const scenes::Script& script() const { return script_; }
  scenes::Script usual_script() const { return scenes::default_script(scene_.scene.spec, scene_.organs); }

  loading::ScriptTrial run(const scenes::Script& script) {
    Model& model = scene_.built.model;
    const auto standing = loading::settle_without_tools(scene_.scene.spec, model);
    stepping::Stepper stepper(model);
    return loading::try_script(model, stepper, standing->state, script, 0).value();
  }

 private:
  std::string folder_;
  loading::LoadedScene scene_;
  scenes::Script script_;
  std::vector<std::string> found_;
};

/// A flat ball of tissue, its box `size` from corner to corner [m].
Lump flat_ball(const std::string& tissue, double size) {
  authoring::ImportRequest request;
  request.organ = tissue, request.size = size, request.spheres = 500;
  return {zoo::moved(zoo::sphere(30, 3), [](Vec3 p) { return Vec3{1.2 * p.x, p.y, 0.8 * p.z}; }), request};
}

TEST(ScriptChoice, ABladeGoesLessDeepIntoASmallSoftOrgan) {
  Lump lump = flat_ball("soft-tissue", 0.11);
  const loading::ScriptTrial usual = lump.run(lump.usual_script()), chosen = lump.run(lump.script());
  EXPECT_TRUE(chosen.was_cut.at(0));
  EXPECT_FALSE(chosen.is_inside_out);
  EXPECT_FALSE(lump.was_found("blade_drags"));
  // The lump is 50 mm high; a blade usually goes 22.5 mm deep.
  EXPECT_LT(lump.cut_depth(), 0.018);
  EXPECT_GT(usual.dragged, 0.08 * 0.050) << "at the usual depth the blade would take the organ along";
  EXPECT_LT(chosen.dragged, 0.08 * 0.050);
}

TEST(ScriptChoice, SlowSaysSoWhereABladeDragsAtAnyDepth) {
  const Lump lump = flat_ball("soft-tissue", 0.03);
  EXPECT_TRUE(lump.was_found("blade_drags"));
}

TEST(ScriptChoice, AnOrganOfUsualSizeIsCutAsDeepAsUsual) {
  Lump lump = flat_ball("liver", 0.25);
  EXPECT_NEAR(lump.cut_depth(), 0.025, 1e-4);
  EXPECT_FALSE(lump.was_found("blade_drags"));
  const loading::ScriptTrial chosen = lump.run(lump.script());
  EXPECT_TRUE(chosen.was_cut.at(0));
  EXPECT_LT(chosen.dragged, 0.003);
}

TEST(ScriptChoice, AWallThatFoldsUnderAPressIsCutBeforeIt) {
  authoring::ImportRequest request;
  request.organ = "soft-tissue", request.sphere_radius = 0.00616, request.unit_in_metres = 0.001;
  Lump wall(zoo::box({12.8, 104, 101}, 4), request);
  const loading::ScriptTrial usual = wall.run(wall.usual_script()), chosen = wall.run(wall.script());
  EXPECT_FALSE(usual.was_cut.at(0)) << "under the usual press the wall would stand, so that this shows nothing";
  EXPECT_TRUE(chosen.was_cut.at(0));
  EXPECT_GT(chosen.severed, 0);
  EXPECT_GT(chosen.most_force, 0.1);
  EXPECT_FALSE(wall.was_found("script_misses"));
}

}  // namespace
}  // namespace ctpm
