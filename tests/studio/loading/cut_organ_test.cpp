// Cuts through the shipped organs, as scenes and scripts make them.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/stepping/step.h"
#include "scenes/script.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm {
namespace {

const std::string kScenes = std::string(CTPM_SOURCE_DIR) + "/scenes";

/// A curve over the top of the kidney; then the ball pushes one bank against the other, and leaves.
constexpr const char* kCutAndPush = R"({
  "format": "ctpm-script", "version": 1, "steps": [
    { "take": { "tool": "scalpel", "at_mm": [-22, -9, 60], "facing": [1, 0, 0] } },
    { "move": { "to_mm": [-22, -9, 24], "speed_mm_per_s": 40 } },
    { "cut": { "path_mm": [[-11, -4, 22], [0, -2, 22], [11, -4, 22], [22, -9, 24]], "speed_mm_per_s": 40, "smooth": true } },
    { "move": { "to_mm": [22, -9, 65], "speed_mm_per_s": 80 } },
    { "put_away": true },
    { "take": { "tool": "ball", "at_mm": [0, 38, 30], "pointing": [0, -1, 0] } },
    { "press": { "distance_mm": 32, "direction": [0, -1, 0], "speed_mm_per_s": 40 } },
    { "wait_s": 0.3 },
    { "release": { "distance_mm": 32, "direction": [0, 1, 0], "speed_mm_per_s": 80 } },
    { "put_away": true }, { "wait_s": 0.4 }] })";

/// How near the spheres of severed elements ever come, in spacings, and how far they are from having changed sides: the
/// least share of the element's rest length that is left along its direction at rest.
struct Lips {
  double least_distance = INFINITY, least_along = INFINITY, along_at_end = INFINITY;
  std::int32_t severed = 0;
};

Lips cut_and_push(bool lips_meet) {
  Lips lips;
  const Result<loading::LoadedScene> scene =
      loading::load_whole_scene(kScenes + "/kidney.json", {}, [&](scenes::SceneSpec& spec) {
        spec.lips_meet = lips_meet;
        for (scenes::ToolSpec& tool : spec.tools)
          if (tool.kind == ToolKind::ball) tool.radius = 0.010;
      });
  EXPECT_TRUE(bool(scene));
  const Model& model = scene->built.model;
  std::vector<std::string> tools;
  for (const Tool& tool : model.tools) tools.push_back(tool.name);
  const Result<scenes::Script> script = scenes::read_script(kCutAndPush, "push.script.json", tools);
  EXPECT_TRUE(bool(script));
  const scenes::ScriptPlayer player(*script, model.tools, model.tick);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  stepper.settle(state, 1000);
  const auto measure = [&] {
    const AxialElements& elements = model.axial;
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (!state.axial_severed[e]) continue;
      const auto a = std::size_t(elements.a[e]), b = std::size_t(elements.b[e]);
      const Vec3 now = state.position[b] - state.position[a], rest = model.rest_position[b] - model.rest_position[a];
      lips.least_distance = std::min(lips.least_distance, norm(now) / model.organs[0].spacing);
      lips.along_at_end = std::min(lips.along_at_end, dot(now, rest) / dot(rest, rest));
    }
  };
  for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) {
    const stepping::StepReport report = stepper.step(state, player.at(tick));
    EXPECT_FALSE(stepping::is_refused(report.status)) << tick;
    lips.severed += report.severed;
    lips.along_at_end = INFINITY;
    measure();
    lips.least_along = std::min(lips.least_along, lips.along_at_end);
  }
  return lips;
}

TEST(CutOrgan, LipsOfACurvedCutMeetAgainAndDoNotPassThroughEachOther) {
  const Lips without = cut_and_push(false), with = cut_and_push(true);
  EXPECT_GT(with.severed, 30);
  EXPECT_LT(without.least_distance, 0.5) << "the ball pushes hard enough for lips to pass";
  EXPECT_GT(with.least_distance, 0.75);
  EXPECT_GT(with.least_along, 0.5) << "a sphere has gone to the other side";
  EXPECT_NEAR(with.along_at_end, 1, 0.1) << "the cut is closed again";
}

}  // namespace
}  // namespace ctpm
