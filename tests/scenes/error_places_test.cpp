// Errors of every stage come together, each with its line and column, and none hides another.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scenes/build_model.h"
#include "scenes/scene_file.h"
#include "scenes/script.h"

namespace ctpm {
namespace {

std::string lines_of(const Errors& errors) {
  std::string all;
  for (const Error& error : errors) all += to_string(error) + "\n";
  return all;
}

/// Errors of reading and building a scene of rigs.
std::string errors_of(const std::string& text) {
  Result<scenes::SceneDraft> draft = scenes::read_draft(text, "t.json");
  if (!draft) return lines_of(draft.errors());
  std::vector<FilledOrgan> organs;
  for (std::size_t i = 0; i < draft->scene.spec.organs.size(); ++i)
    organs.push_back(scenes::can_be_filled(draft->problems, i) ? scenes::fill_rig(draft->scene.spec.organs[i])
                                                               : FilledOrgan{});
  const bool is_built = scenes::build_model(draft->scene.spec, organs, draft->problems).has_value();
  EXPECT_EQ(is_built, draft->problems.is_empty());
  return lines_of(draft->problems.errors());
}

/// A scene with one organ a line, from line 2 on, and more keys in the line after them.
std::string scene_with(const std::vector<std::string>& organs, const std::string& more = "") {
  std::string text = "{\"format\": \"ctpm-scene\", \"version\": 1, \"name\": \"t\", \"organs\": [";
  for (std::size_t i = 0; i < organs.size(); ++i)
    text +=
        (i == 0 ? "\n{\"name\": \"" : ",\n{\"name\": \"") + std::string(1, char('a' + i)) + "\", " + organs[i] + "}";
  return text + "]\n" + more + "}\n";
}
/// 3 x 3 x 3 spheres, 12 mm apart, 6 to 18 mm deep.
const std::string kBlock = R"("rig": {"block": [3, 3, 3]}, )", kLiver = R"("material": {"preset": "liver"})";
const std::string kFarAnchor =
    R"("anchors": [{"lowest_mm": 2}, {"sphere": {"centre_mm": [0, 0, 500], "radius_mm": 9}}], )";
const std::string kExtent = "holds no sphere (its spheres lie from -12.0, -12.0, 0.0 to 12.0, 12.0, 24.0 mm)\n";

TEST(ErrorPlaces, AGoodSceneIsBuilt) { EXPECT_EQ(errors_of(scene_with({kBlock + kLiver, kBlock + kLiver})), ""); }

TEST(ErrorPlaces, AnAnchorThatHoldsNoSphere) {
  EXPECT_EQ(errors_of(scene_with({kFarAnchor + kBlock + kLiver})),
            "t.json:2:45: error: /organs/0/anchors/1: " + kExtent);
}

TEST(ErrorPlaces, LayersThatTheOrganDoesNotHave) {
  const std::string skin = R"("material": {"preset": "skin"})";
  EXPECT_EQ(errors_of(scene_with({kBlock + kLiver + ",\n\"layers\": [{\"to_depth_mm\": 5, " + skin +
                                  "},\n{\"to_depth_mm\": 40, " + skin + "}]"})),
            "t.json:3:28: error: /organs/0/layers/0/to_depth_mm: the layer from 0 mm to 5 mm holds no sphere (its "
            "spheres lie 6 mm to 18 mm below its surface)\n"
            "t.json:4:17: error: /organs/0/layers/1/to_depth_mm: got 40 mm, which is deeper than the organ (its "
            "spheres lie 6 mm to 18 mm below its surface)\n");
}

TEST(ErrorPlaces, SpheresThatNothingJoins) {
  EXPECT_EQ(errors_of(scene_with({R"("rig": {"cells": [[0, 0, 0], [5, 0, 0]]}, )" + kLiver})),
            "t.json:2:32: error: /organs/0/rig/cells: no two of the 2 spheres are neighbours, so nothing joins them "
            "(neighbours differ by 1 along one axis or two)\n");
}

TEST(ErrorPlaces, AMaterialThatIsNotWholeOrHasAWeakConstraint) {
  const std::string all = errors_of(scene_with(
      {kBlock + R"("material": {"preset": "skim"})",
       kBlock + R"("material": {"preset": "liver", "constraint_kpa_per_mm": 7})",
       kBlock +
           R"("material": {"kelvin_kpa_per_mm": 15, "constraint_kpa_per_mm": 20, "viscosity_kpa_s_per_mm": 5, "calibration_ball_radius_mm": 2, "calibration_spacing_mm": 12})"}));
  EXPECT_EQ(all,
            "t.json:2:67: error: /organs/0/material/preset: there is no preset \"skim\" (did you mean \"skin\"?)\n"
            "t.json:3:101: error: /organs/1/material/constraint_kpa_per_mm: got 7 kPa/mm, must be at least K1 K2 / (K1 "
            "+ K2) = 7.5, which the triples already give\n"
            "t.json:4:56: error: /organs/2/material: the key \"spring_kpa_per_mm\" is missing, and there is no preset "
            "to take it from\n");
}

TEST(ErrorPlaces, AnIntegratorThatIsUnstableForTheScene) {
  const std::string all = errors_of(scene_with({kBlock + kLiver}, ", \"solver\": {\"integrator\": \"leapfrog\"}"));
  EXPECT_EQ(all.find("t.json:3:28: error: /solver/integrator: leapfrog: it is asked for, but"), 0u) << all;
}

TEST(ErrorPlaces, ToolsCamerasPinsLoadsAndProbes) {
  EXPECT_EQ(
      errors_of(scene_with({kBlock + kLiver}, R"(, "tools": [{"name": "b", "kind": "ball"},
{"name": "p", "kind": "pin", "holds_mm": [0, 1e9, 0]}],
"cameras": [{"name": "c", "eye_mm": [1, 2, 3], "target_mm": [1, 2, 3]}],
"loads": [{"at_mm": [0, 0, 0], "force_n": [0, 0, "heavy"]}],
"probes": [{"name": "q", "at_mm": [0, 0]}])")),
      "t.json:3:13: error: /tools/0: a ball needs the key \"radius_mm\"\n"
      "t.json:4:46: error: /tools/1/holds_mm/1: got 1e9, must be in [-100000, 100000] mm\n"
      "t.json:5:61: error: /cameras/0/target_mm: must not be the same point as eye_mm\n"
      "t.json:6:50: error: /loads/0/force_n/2: got the text \"heavy\", must be a number in [-1000000, 1000000] N\n"
      "t.json:7:35: error: /probes/0/at_mm: got a list of 2, must be a list of 3 numbers\n");
}

TEST(ErrorPlaces, ARangeErrorHidesNoErrorOfBuilding) {
  // The same organ has a modulus and a colour out of range, and an anchor that can be judged all the same.
  EXPECT_EQ(
      errors_of(scene_with({kFarAnchor + kBlock +
                            R"("inner_color": [2, 0, 0], "material": {"preset": "liver", "spring_kpa_per_mm": -1})"},
                           ", \"tick_s\": 9, \"solver\": {\"integrator\": \"leapfrog\"}")),
      "t.json:2:45: error: /organs/0/anchors/1: " + kExtent +
          "t.json:2:147: error: /organs/0/inner_color/0: got 2, must be in [0, 1]\n"
          "t.json:2:210: error: /organs/0/material/spring_kpa_per_mm: got -1, must be in [1e-6, 1000000] kPa/mm\n"
          "t.json:3:13: error: /tick_s: got 9, must be in [1e-6, 0.1] s\n");
}

TEST(ErrorPlaces, ARangeErrorThatTheStabilityDoesNotDependOnHidesNoUnstableIntegrator) {
  const std::string all =
      errors_of(scene_with({R"("inner_color": [2, 0, 0], )" + kBlock + kLiver},
                           ",\n\"solver\": {\"integrator\": \"leapfrog\"},\n\"contact_friction\": -1"));
  EXPECT_NE(all.find("t.json:2:31: error: /organs/0/inner_color/0: got 2"), std::string::npos) << all;
  EXPECT_NE(all.find("t.json:4:26: error: /solver/integrator: leapfrog"), std::string::npos) << all;
  EXPECT_NE(all.find("t.json:5:21: error: /contact_friction: got -1"), std::string::npos) << all;
}

TEST(ErrorPlaces, AnErrorInOneOrganHidesNoneInAnother) {
  EXPECT_EQ(errors_of(scene_with({R"("fill": {"radius_mm": 0}, )" + kBlock + kLiver, kFarAnchor + kBlock + kLiver,
                                  R"("rig": {"cells": [[0, 0, 0], [0, 0, 2]]}, )" + kLiver})),
            "t.json:2:37: error: /organs/0/fill/radius_mm: got 0, must be in [0.01, 100] mm\n"
            "t.json:3:45: error: /organs/1/anchors/1: " +
                kExtent +
                "t.json:4:32: error: /organs/2/rig/cells: no two of the 2 spheres are neighbours, so nothing joins "
                "them (neighbours differ by 1 along one axis or two)\n");
}

TEST(ErrorPlaces, WhatDependsOnARefusedValueIsNotReported) {
  // Spheres of an unknown radius cannot be judged: no anchor holds them and nothing joins them.
  const std::string far = R"("anchors": [{"sphere": {"centre_mm": [0, 0, 500], "radius_mm": 9}}], )";
  EXPECT_EQ(errors_of(scene_with({R"("fill": {"radius_cm": 0.2}, )" + far + kBlock + kLiver})),
            "t.json:2:24: error: /organs/0/fill/radius_cm: unknown key \"radius_cm\" (the key is \"radius_mm\": the "
            "unit is part of it)\n");
  EXPECT_EQ(errors_of(scene_with({R"("rick": {"block": [3, 3, 3]}, )" + kLiver})),
            "t.json:2:15: error: /organs/0/rick: unknown key \"rick\" (did you mean \"rig\"?)\n");
  EXPECT_EQ(
      errors_of(scene_with({kBlock + kLiver}, R"(, "tools": [{"name": "b", "kind": "hook", "radius_mm": 5}])")),
      "t.json:3:35: error: /tools/0/kind: got the text \"hook\", must be one of \"ball\", \"scalpel\", \"pin\"\n");
  EXPECT_EQ(errors_of(scene_with({kBlock + kLiver}, R"(, "tools": [{"name": "b", "kind": "ball", "radius_mm": 0}])")),
            "t.json:3:56: error: /tools/0/radius_mm: got 0, must be in [0.01, 200] mm\n");
  EXPECT_EQ(errors_of(scene_with({R"("rig": {"cells": [[0, 0, 0], [0, 0, 9999], [0, 0, "x"]]}, )" + kLiver})),
            "t.json:2:51: error: /organs/0/rig/cells/1/2: got 9999, must be in [-1000, 1000]\n"
            "t.json:2:65: error: /organs/0/rig/cells/2/2: got the text \"x\", must be a number in [-1000, 1000]\n");
}

TEST(ErrorPlaces, AMissingMeshHidesNoAnchorOfAnotherOrgan) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "ctpm_error_places";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "s.json").string();
  std::ofstream(path, std::ios::binary) << scene_with(
      {R"("mesh": "no.obj", )" + kFarAnchor + kLiver, kFarAnchor + kBlock + kLiver});
  Result<scenes::SceneDraft> draft = scenes::load_draft(path);
  ASSERT_TRUE(draft);
  EXPECT_FALSE(scenes::can_be_filled(draft->problems, 0));
  ASSERT_TRUE(scenes::can_be_filled(draft->problems, 1));
  EXPECT_FALSE(scenes::build_model(
      draft->scene.spec, std::vector{FilledOrgan{}, scenes::fill_rig(draft->scene.spec.organs[1])}, draft->problems));
  EXPECT_EQ(lines_of(draft->problems.errors()),
            path + ":2:23: error: /organs/0/mesh: there is no file \"no.obj\" in the scene's folder (looked for " +
                (folder / "no.obj").string() + ")\n" + path + ":3:45: error: /organs/1/anchors/1: " + kExtent);
  std::filesystem::remove_all(folder);
}

TEST(ErrorPlaces, ASceneThatWasReadKeepsThePlacesOfItsValues) {
  const Result<scenes::SceneText> scene =
      scenes::read_scene(scene_with({kBlock + kLiver}, ", \"tick_s\": 0.001"), "t.json");
  ASSERT_TRUE(scene);
  EXPECT_EQ(to_string(scene->places.error_at("/tick_s", "is long", "shorten it")),
            "t.json:3:13: error: /tick_s: is long (shorten it)");
  // What is not written stands where it would stand: in the object around it.
  EXPECT_EQ(scene->places.error_at("/organs/0/fill/gap_mm", "is wide").where, "t.json:2:1");
  EXPECT_EQ(scene->places.error_at("/organs/7/name", "is odd").where, "t.json:1:63");
}

TEST(ErrorPlaces, TextThatIsNestedTooDeepIsRefusedAtTheBracket) {
  const std::string deep = "{\"a\": \"\\\"[{\",\n\"b\": " + std::string(70, '[') + std::string(70, ']') + "}";
  EXPECT_EQ(errors_of(deep), "t.json:2:69: error: nested deeper than 64 levels\n");
}

TEST(ErrorPlaces, AScriptsErrorsHideNoneOfEachOther) {
  const auto errors = [](const std::string& steps) {
    const Result<scenes::Script> script = scenes::read_script(
        "{\"format\": \"ctpm-script\", \"version\": 1, \"steps\": [\n" + steps + "]}", "s.json", {"ball"});
    return script ? "" : lines_of(script.errors());
  };
  EXPECT_EQ(errors("{\"press\": {\"distance_mm\": 0, \"direction\": [0, 0, 0], \"speed_mm_per_s\": 9}},\n"
                   "{\"take\": {\"tool\": \"saw\", \"at_mm\": [0, 0, 0], \"pointing\": [0, 0, 0]}}"),
            "s.json:2:1: error: /steps/0: there is no tool in the hand here (take one first)\n"
            "s.json:2:27: error: /steps/0/press/distance_mm: got 0, must be in (0, 1000] mm\n"
            "s.json:2:43: error: /steps/0/press/direction: must not be zero, or shorter than 1e-9\n"
            "s.json:3:19: error: /steps/1/take/tool: the scene has no tool \"saw\" (its tools: ball)\n"
            "s.json:3:58: error: /steps/1/take/pointing: must not be zero, or shorter than 1e-9\n");
  // After a misspelt take nobody knows what is in the hand.
  const std::string all = errors(
      "{\"tak\": {\"tool\": \"ball\", \"at_mm\": [0, 0, 0]}},\n"
      "{\"move\": {\"to_mm\": [0, 0, 0], \"speed_mm_per_s\": 9}}");
  EXPECT_EQ(all.find("s.json:2:2: error: /steps/0/tak: unknown key"), all.find("s.json:2:2")) << all;
  EXPECT_EQ(all.find("/steps/1"), std::string::npos) << all;
}

TEST(Problems, AValueIsGoodUnlessItOrSomethingInItOrAroundItIsRefused) {
  scenes::Problems problems;
  EXPECT_TRUE(problems.is_good("/a/1"));
  problems.add_rule("/a/1/b", "is wrong");
  for (const char* refused : {"", "/a", "/a/1", "/a/1/b", "/a/1/b/0/c"})
    EXPECT_FALSE(problems.is_good(refused)) << refused;
  for (const char* good : {"/a/10", "/a/1/bc", "/a/1/c", "/b", "/a/2"}) EXPECT_TRUE(problems.is_good(good)) << good;
  EXPECT_TRUE(problems.are_good("/a/1", {"c", "d"}));
  EXPECT_FALSE(problems.are_good("/a/1", {"c", "b"}));
}

TEST(Problems, ARefusedValueIsReportedOnce) {
  scenes::Problems problems;
  problems.add_rule("/a", "the key \"b\" is missing", "", "/a/b");
  problems.add_rule("/a/b", "follows from it");
  problems.add_rule("/a/c", "does not");
  EXPECT_EQ(lines_of(problems.errors()), "/a: error: the key \"b\" is missing\n/a/c: error: does not\n");
}

}  // namespace
}  // namespace ctpm
