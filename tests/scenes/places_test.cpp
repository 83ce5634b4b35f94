// Places that an author gives by their meaning.

#include "scenes/places.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scene_file.h"
#include "scenes/script.h"

namespace ctpm {
namespace {

using scenes::PlaceFinder;

/// A box from (0, 0, 0) to (60, 40, 20) mm with a ridge: its top rises from 20 to 30 mm along x.
Surface wedge() {
  Surface s;
  for (const double x : {0.0, 0.06})
    for (const double y : {0.0, 0.04})
      for (const double z : {0.0, x == 0 ? 0.02 : 0.03}) s.vertex.push_back({x, y, z});
  s.triangle = {{0, 2, 4}, {2, 6, 4}, {1, 5, 3}, {3, 5, 7}, {0, 4, 1}, {1, 4, 5},
                {2, 3, 6}, {3, 7, 6}, {0, 1, 2}, {1, 3, 2}, {4, 6, 5}, {5, 6, 7}};
  return s;
}

/// What is found for a text, or its error.
std::string found(const PlaceFinder& finder, const std::string& text, bool is_direction = false) {
  const Result<scenes::PlacePhrase> phrase = scenes::parse_place(text, is_direction);
  if (!phrase) return phrase.errors().front().message;
  const Result<std::optional<Vec3>> place = finder.find(*phrase);
  if (!place) return place.errors().front().message + " (" + place.errors().front().hint + ")";
  if (!*place) return "open";
  const double unit = is_direction ? 1 : 1e3;
  char line[96];
  std::snprintf(line, sizeof line, "%.3f %.3f %.3f", unit * (*place)->x, unit * (*place)->y, unit * (*place)->z);
  return line;
}

TEST(Places, AreFoundOnTheSurface) {
  const Surface surface = wedge();
  PlaceFinder finder({{"liver", &surface}, {"left kidney at rest", &surface}}, {0, 0, -9.81});
  finder.add_probe("entry", Vec3{0.001, 0.002, 0.003});
  EXPECT_EQ(found(finder, "top of liver"), "60.000 0.000 30.000");
  EXPECT_EQ(found(finder, "bottom of liver"), "0.000 0.000 0.000");
  EXPECT_EQ(found(finder, "centre of liver"), "30.000 20.000 15.000");
  EXPECT_EQ(found(finder, "surface of liver at 30 10"), "30.000 10.000 25.000");
  EXPECT_EQ(found(finder, "surface of left kidney at rest at 30 10"), "30.000 10.000 25.000");
  EXPECT_EQ(found(finder, "entry"), "1.000 2.000 3.000");
  EXPECT_EQ(found(finder, "surface of liver at 30 10 + 0 -1 15"), "30.000 9.000 40.000");
  // The top's normal: (-1, 0, 6) / sqrt(37).
  EXPECT_EQ(found(finder, "surface of liver at 30 10 out 10"), "28.356 10.000 34.864");
  EXPECT_EQ(found(finder, "into surface of liver at 30 10", true), "0.164 0.000 -0.986");
  EXPECT_EQ(found(finder, "out of surface of liver at 30 10", true), "-0.164 0.000 0.986");
  // Up is against gravity.
  EXPECT_EQ(found(PlaceFinder({{"liver", &surface}}, {-9.81, 0, 0}), "top of liver"), "60.000 0.000 0.000");
}

TEST(Places, MistakesNameWhatThereIs) {
  const Surface surface = wedge();
  PlaceFinder finder({{"liver", &surface}, {"kidney", nullptr}}, {0, 0, -9.81});
  finder.add_probe("entry", std::nullopt);
  EXPECT_EQ(found(finder, "top of spleen"), "there is no organ \"spleen\" (organs: liver, kidney)");
  EXPECT_EQ(found(finder, "top of kidney"), "open") << "not filled yet";
  EXPECT_EQ(found(finder, "entry"), "open");
  EXPECT_EQ(found(finder, "entri").find("there is no place \"entri\" (probes: entry; places are written like"), 0u);
  EXPECT_EQ(found(finder, "surface of liver at 300 10"), "no part of \"liver\" is over 300 10 ()");
  EXPECT_EQ(found(finder, "surface of liver"), "got the text \"surface of liver\", which is no place");
  EXPECT_EQ(found(finder, "top of liver", true), "got the text \"top of liver\", which is no direction");
}

const std::string kScene = R"({"format": "ctpm-scene", "version": 1, "name": "t",
"organs": [{"name": "liver", "mesh": "a.obj", "material": {"preset": "liver"}}],
"probes": [{"name": "entry", "at_mm": "top of liver"}],
"tools": [{"name": "ball", "kind": "ball", "radius_mm": 5, "at_mm": "entry + 0 0 25", "pointing": "into entry"}],
"cameras": [{"name": "front", "eye_mm": [0, -300, 100], "target_mm": "centre of liver"}], "tick_s": 9})";

TEST(Places, StandForCoordinatesWhereASceneIsRead) {
  const Surface surface = wedge();
  PlaceFinder finder({{"liver", &surface}}, {0, 0, -9.81});
  std::string good = kScene;
  good.replace(good.find(": 9}"), 4, ": 0.001}");
  const Result<scenes::SceneDraft> draft = scenes::read_draft(good, "t.json", &finder);
  ASSERT_TRUE(draft);
  EXPECT_TRUE(draft->problems.is_empty()) << to_string(draft->problems.errors().front());
  EXPECT_TRUE(draft->open_places.empty());
  const scenes::SceneSpec& spec = draft->scene.spec;
  EXPECT_EQ(spec.probes[0].at, (Vec3{0.06, 0, 0.03}));
  EXPECT_EQ(spec.tools[0].at, (Vec3{0.06, 0, 0.055}));
  EXPECT_EQ(spec.cameras[0].target, (Vec3{0.03, 0.02, 0.015}));
  // A session keeps coordinates, so that it can be read where there are no organs.
  EXPECT_NE(draft->scene.found_text.find("\"at_mm\": [60, 0, 30] /* top of liver */"), std::string::npos);
  const Result<scenes::SceneText> again = scenes::read_scene(draft->scene.found_text, "t.json");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->spec, spec);
}

TEST(Places, KeepThePlacesOfErrorsAndAreErrorsWithoutOrgans) {
  const Surface surface = wedge();
  PlaceFinder finder({{"liver", &surface}}, {0, 0, -9.81});
  const Result<scenes::SceneDraft> draft = scenes::read_draft(kScene, "t.json", &finder);
  ASSERT_TRUE(draft);
  ASSERT_EQ(draft->problems.errors().size(), 1u);
  EXPECT_EQ(draft->problems.errors()[0].where,
            "t.json:5:" + std::to_string(kScene.substr(kScene.rfind('\n')).find("9}")));
  const Result<scenes::SceneText> alone = scenes::read_scene(kScene, "t.json");
  ASSERT_FALSE(alone);
  EXPECT_NE(to_string(alone.errors()[0]).find("t.json:3:39: error: /probes/0/at_mm: is a place on an organ"),
            std::string::npos)
      << to_string(alone.errors()[0]);
  // Names are judged before any mesh is read.
  std::string wrong = kScene;
  wrong.replace(wrong.find("top of liver"), 12, "top of lever");
  EXPECT_NE(to_string(scenes::read_scene(wrong, "t.json").errors()[0]).find("there is no organ \"lever\""),
            std::string::npos);
}

TEST(Places, AreFoundInScripts) {
  const Surface surface = wedge();
  PlaceFinder finder({{"liver", &surface}}, {0, 0, -9.81});
  const std::string text = R"({"format": "ctpm-script", "version": 1, "steps": [
{"take": {"tool": "knife", "at_mm": "surface of liver at 30 10 out 20", "pointing": "into surface of liver at 30 10"}},
{"cut": {"path_mm": ["surface of liver at 30 10 out -5", [40, 10, 20], "surface of liver at 50 10 + 0 0 -5"], "speed_mm_per_s": 30}},
{"press": {"distance_mm": 5, "direction": "into surface of liver at 30 10", "speed_mm_per_s": 30}}]})";
  const Result<scenes::Script> script = scenes::read_script(text, "s.json", {"knife"}, true, &finder);
  ASSERT_TRUE(script) << to_string(script.errors()[0]);
  EXPECT_NEAR(script->steps[0].take->at.z, 0.044728, 1e-6);
  EXPECT_EQ(script->steps[1].cut->path[1], (Vec3{0.04, 0.01, 0.02}));
  EXPECT_NEAR(script->steps[1].cut->path[2].z, 0.025 + 0.02 / 6 - 0.005, 1e-6);
  EXPECT_LT(script->steps[2].press->direction.z, -0.5);
  const Result<scenes::Script> wrong = scenes::read_script(
      R"({"format": "ctpm-script", "version": 1, "steps": [{"take": {"tool": "knife", "at_mm": "up"}}]})", "s.json",
      {"knife"}, true, &finder);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.errors()[0].where, "s.json:1:87");
}

}  // namespace
}  // namespace ctpm
