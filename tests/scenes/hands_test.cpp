// Scenes and scripts of two hands.

#include <gtest/gtest.h>

#include <string>

#include "scenes/build_model.h"
#include "scenes/scene_file.h"
#include "scenes/script.h"

namespace ctpm {
namespace {

std::string scene_with(const std::string& more) {
  return R"({"format": "ctpm-scene", "version": 1, "name": "block",
"organs": [{"name": "block", "rig": {"block": [3, 3, 3]}, "material": {"preset": "liver"}}],
"tools": [{"name": "ball", "kind": "ball", "radius_mm": 6}, {"name": "other", "kind": "ball", "radius_mm": 4},
  {"name": "scalpel", "kind": "scalpel", "blade_length_mm": 50}, {"name": "saw", "kind": "scalpel", "blade_length_mm": 50},
  {"name": "pin", "kind": "pin", "holds_mm": [0, 0, 24]}, {"name": "same pin", "kind": "pin", "holds_mm": [1, 0, 24]}])" +
         more + "}";
}

Model model_of(const std::string& more) {
  const Result<scenes::SceneText> scene = scenes::read_scene(scene_with(more), "s.json");
  CTPM_CHECK(bool(scene), "a test's own scene is valid");
  const std::vector<FilledOrgan> organs{scenes::fill_rig(scene->spec.organs[0])};
  return scenes::build_model(scene->spec, organs)->model;
}

std::string script_of(const std::string& steps) {
  return "{\"format\": \"ctpm-script\", \"version\": 1, \"steps\": [\n" + steps + "\n]}\n";
}

std::string take(const std::string& tool, int hand) {
  return R"({"take": {"tool": ")" + tool + R"(", "at_mm": [0, 0, 50]}, "hand": )" + std::to_string(hand) + "}";
}

std::string errors_of(const std::string& steps, const Model& model) {
  const Result<scenes::Script> script = scenes::read_script_for(script_of(steps), "s.json", model);
  if (script) return "";
  std::string all;
  for (const Error& error : script.errors()) all += to_string(error) + "\n";
  return all;
}

TEST(Hands, AreOneUnlessTheSceneHasTwo) {
  EXPECT_EQ(model_of("").hands, 1);
  EXPECT_EQ(model_of(", \"hands\": 1").hands, 1);
  EXPECT_EQ(model_of(", \"hands\": 2").hands, 2);
  for (const std::string bad : {"0", "3", "1.5", "\"two\""}) {
    const auto scene = scenes::read_scene(scene_with(", \"hands\": " + bad), "s.json");
    ASSERT_FALSE(scene) << bad;
    EXPECT_NE(to_string(scene.errors().front()).find("s.json:5:"), std::string::npos)
        << to_string(scene.errors().front());
  }
  const auto scene = scenes::read_scene(scene_with(", \"hands\": 2"), "s.json");
  ASSERT_TRUE(scene);
  EXPECT_NE(scenes::write_scene(scene->spec).find("\"hands\": 2"), std::string::npos);
  EXPECT_EQ(scenes::write_scene(scenes::read_scene(scene_with(""), "s.json")->spec).find("hands"), std::string::npos);
}

TEST(Hands, WithOneToolAreWarnedOf) {
  const auto scene = scenes::read_scene(
      R"({"format": "ctpm-scene", "version": 1, "name": "b", "hands": 2,
"organs": [{"name": "b", "rig": {"block": [3, 3, 3]}, "material": {"preset": "liver"}}],
"tools": [{"name": "ball", "kind": "ball", "radius_mm": 6}]})",
      "s.json");
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->warnings.size(), 1u);
  EXPECT_EQ(to_string(scene->warnings[0]), "s.json:1:62: error: /hands: two hands need two tools, and the scene has 1");
}

TEST(HandsOfAScript, AreThoseOfTheScene) {
  const Model one = model_of(""), two = model_of(", \"hands\": 2");
  EXPECT_EQ(errors_of(take("ball", 2), two), "");
  EXPECT_EQ(errors_of(take("ball", 1), one), "");
  EXPECT_EQ(errors_of(take("ball", 2), one),
            "s.json:2:57: error: /steps/0/hand: the scene has one hand (write \"hands\": 2 in the scene)\n");
  EXPECT_NE(errors_of(take("ball", 3), two).find("/steps/0/hand: got 3, must be in [1, 2]"), std::string::npos);
  EXPECT_EQ(errors_of(R"({"wait_s": 1, "hand": 2})", two),
            "s.json:2:23: error: /steps/0/hand: both hands hold still (leave it out)\n");
  EXPECT_FALSE(scenes::read_script(script_of(take("ball", 2)), "s.json", {"ball"}));
  EXPECT_TRUE(scenes::read_script(script_of(take("ball", 2)), "s.json", {"ball"}, 2));
}

TEST(HandsOfAScript, HoldWhatGoesTogether) {
  const Model model = model_of(", \"hands\": 2");
  const auto after = [&](const std::string& first, const std::string& second) {
    return errors_of(take(first, 1) + ",\n" + take(second, 2), model);
  };
  EXPECT_EQ(after("ball", "other"), "");
  EXPECT_EQ(after("ball", "scalpel"), "");
  EXPECT_EQ(after("pin", "ball"), "");
  EXPECT_EQ(after("ball", "ball"),
            "s.json:3:19: error: /steps/1/take/tool: both hands hold the same tool (put \"ball\" away first)\n");
  EXPECT_NE(after("scalpel", "saw").find("one blade cuts at a time (put \"scalpel\" away first)"), std::string::npos);
  EXPECT_NE(after("pin", "same pin").find("the pins in both hands hold the same sphere"), std::string::npos);
  EXPECT_EQ(errors_of(take("ball", 1) + R"(, {"put_away": true}, )" + take("ball", 2), model), "");
  // Each hand has its own tool.
  EXPECT_NE(errors_of(take("ball", 1) + R"(, {"move": {"to_mm": [0, 0, 0], "speed_mm_per_s": 9}, "hand": 2})", model)
                .find("there is no tool in the hand here"),
            std::string::npos);
}

TEST(HandsOfAScript, OneMovesWhileTheOtherHoldsStill) {
  const Model model = model_of(", \"hands\": 2");
  const auto script = scenes::read_script_for(script_of(take("ball", 2) + R"(,
{"press": {"distance_mm": 30, "speed_mm_per_s": 40, "until_force_n": 0.5}, "hand": 2},
{"take": {"tool": "scalpel", "at_mm": [9, 0, 50]}},
{"move": {"to_mm": [9, 0, 20], "speed_mm_per_s": 40}},
{"put_away": true}, {"put_away": true, "hand": 2})"),
                                              "s.json", model);
  ASSERT_TRUE(script) << to_string(script.errors().front());
  EXPECT_EQ(*scenes::read_script_for(scenes::write_script(*script), "again.json", model), *script);
  scenes::ScriptPlayer player(*script, model.tools, model.tick);
  // The tissue pushes back with 0.5 N when the ball is 12 mm down.
  std::int64_t tick = 0, ended = -1;
  Vec3 before, held;
  for (; tick < player.tick_count(); ++tick) {
    const Inputs inputs = player.at(tick);
    if (ended < 0) {
      EXPECT_EQ(inputs.tool, -1);
      EXPECT_EQ(player.hand_at(tick), 1u);
      before = inputs.second.position;
      const double depth = 0.05 - inputs.second.position.z;
      if (player.feel(tick, {0, 0, depth >= 0.012 ? 0.5 : 0.0}) == scenes::PressEnd::at_force)
        ended = tick, held = inputs.second.position;
      continue;
    }
    if (tick == player.tick_count() - 1) break;
    EXPECT_EQ(inputs.second.tool, 0) << "the ball stays in the second hand";
    EXPECT_EQ(inputs.second.position, held);
    EXPECT_TRUE(inputs.tool == -1 || inputs.tool == 2);
    EXPECT_LT(norm(inputs.second.position - before), 1e-9);
  }
  ASSERT_GT(ended, 0);
  EXPECT_NEAR(held.z, 0.038, 1e-4);
  const Inputs last = player.at(player.tick_count() - 1);
  EXPECT_EQ(last.tool, -1);
  EXPECT_EQ(last.second.tool, -1);
}

}  // namespace
}  // namespace ctpm
