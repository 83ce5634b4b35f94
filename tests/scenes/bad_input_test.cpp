#include <gtest/gtest.h>

#include <string>

#include <vector>
#include "scenes/presets.h"

#include "scenes/presets.h"
#include "scenes/scene_file.h"

namespace ctpm {
namespace {

/// A scene with one organ, whose keys stand in line 2 from column 1 on, and more keys in line 3.
std::string scene_with(const std::string& organ_keys, const std::string& more = "") {
  return "{\"format\": \"ctpm-scene\", \"version\": 1, \"name\": \"t\", \"organs\": [{\"name\": \"a\",\n" + organ_keys +
         "}]\n" + more + "}\n";
}
std::string errors_of(const std::string& text) {
  const Result<scenes::SceneText> scene = scenes::read_scene(text, "t.json");
  if (scene) return "no error";
  std::string all;
  for (const Error& error : scene.errors()) all += to_string(error) + "\n";
  return all;
}
const std::string kMesh = R"("mesh": "a.obj", )", kLiver = R"("material": {"preset": "liver"})";

TEST(BadInput, AnObstacleIsAPlaneOrABoxAndHasAPlaceAndASize) {
  const std::string text = errors_of(scene_with(kMesh + kLiver, R"(, "obstacles": [
{"name": "a"},
{"name": "a", "plane": {"point_mm": [0, 0, 0], "normal": [0, 0, 0]}},
{"name": "b", "box": {"min_mm": [0, 0, 0], "max_mm": [1, 0, 1]}},
{"name": "c", "box": {"min_mm": [0, 0, 9], "max_mm": [1, 1, 1]}}], "organs_meet": 1)"));
  for (const char* part : {"t.json:4:1: error: /obstacles/0: must have exactly one of plane, box, mesh",
                           "t.json:5:10: error: /obstacles/1/name: got \"a\", which is taken already",
                           "t.json:5:", "/obstacles/1/plane/normal", "/obstacles/2/box: has no volume",
                           "/obstacles/3/box: min_mm must not be above max_mm", "/organs_meet"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  const std::string rig = errors_of(scene_with(R"("rig": {"block": [2, 2, 2]}, "meets_itself": true, )" + kLiver));
  EXPECT_NE(rig.find("/organs/0/meets_itself: a rig has no surface"), std::string::npos) << rig;
}

/// A number that an author writes, with its key's range.
struct Field {
  const char* pointer;
  std::string before, after;  ///< organ keys around the number
  const char* range;
};
const Field kFields[] = {
    {"/organs/0/fill/radius_mm", R"("fill": {"radius_mm": )", "}, " + kMesh + kLiver, "[0.01, 100] mm"},
    {"/organs/0/fill/gap_mm", R"("fill": {"gap_mm": )", "}, " + kMesh + kLiver, "[0, 100] mm"},
    {"/organs/0/material/spring_kpa_per_mm", R"("material": {"spring_kpa_per_mm": )",
     R"(, "preset": "liver"}, "mesh": "a.obj")", "[1e-6, 1000000] kPa/mm"},
    {"/organs/0/material/kelvin_kpa_per_mm", R"("material": {"kelvin_kpa_per_mm": )",
     R"(, "preset": "liver"}, "mesh": "a.obj")", "[1e-6, 1000000] kPa/mm"},
    {"/organs/0/material/constraint_kpa_per_mm", R"("material": {"constraint_kpa_per_mm": )",
     R"(, "preset": "liver"}, "mesh": "a.obj")", "[1e-6, 1000000] kPa/mm"},
    {"/organs/0/material/viscosity_kpa_s_per_mm", R"("material": {"viscosity_kpa_s_per_mm": )",
     R"(, "preset": "liver"}, "mesh": "a.obj")", "[0, 1000000] kPa s/mm"},
    {"/organs/0/material/density_kg_per_m3", R"("material": {"density_kg_per_m3": )",
     R"(, "preset": "liver"}, "mesh": "a.obj")", "[1, 30000] kg/m^3"},
    {"/organs/0/material/stiffness_scale", R"("material": {"stiffness_scale": )",
     R"(, "preset": "liver"}, "mesh": "a.obj")", "[1e-6, 1000000]"},
    {"/organs/0/material/calibration_ball_radius_mm", R"("material": {"calibration_ball_radius_mm": )",
     R"(, "preset": "liver"}, "mesh": "a.obj")", "[0.01, 1000] mm"},
    {"/organs/0/material/calibration_spacing_mm", R"("material": {"calibration_spacing_mm": )",
     R"(, "preset": "liver"}, "mesh": "a.obj")", "[0.01, 1000] mm"},
};

TEST(BadInput, ANumberOutOfRangeIsRefusedWhereItStands) {
  for (const Field& field : kFields) {
    const std::string place = "t.json:2:" + std::to_string(field.before.size() + 1) + ": error: " + field.pointer;
    std::vector<std::string> numbers{"-1", "-1e-300", "1e300", "123456789"};
    const bool may_be_zero = std::string(field.range).starts_with("[0, ");
    if (!may_be_zero) numbers.insert(numbers.end(), {"0", "-0.0", "1e-300"});
    for (const std::string& number : numbers)
      EXPECT_EQ(errors_of(scene_with(field.before + number + field.after)),
                place + ": got " + number + ", must be in " + field.range + "\n");
  }
}

TEST(BadInput, WhatIsNotANumberIsRefusedWhereItStands) {
  for (const Field& field : kFields) {
    const std::string place = "t.json:2:" + std::to_string(field.before.size() + 1) + ": error: ";
    for (const auto& [value, got] : std::vector<std::pair<std::string, std::string>>{{"\"nan\"", "the text \"nan\""},
                                                                                     {"null", "null"},
                                                                                     {"true", "true"},
                                                                                     {"[4]", "a list of 1"},
                                                                                     {"{}", "an object"}})
      EXPECT_EQ(errors_of(scene_with(field.before + value + field.after)),
                place + field.pointer + ": got " + got + ", must be a number in " + field.range + "\n");
    // These are not JSON at all.
    for (const std::string value : {"NaN", "-nan", "Infinity", "+4", ".5", "0x10", "04", "1e"})
      EXPECT_EQ(errors_of(scene_with(field.before + value + field.after)).find("t.json:2:"), 0u) << value;
    EXPECT_NE(errors_of(scene_with(field.before + "1e999" + field.after)).find("too large for a double"),
              std::string::npos);
  }
}

TEST(BadInput, APresetThatDoesNotExistIsNamedWithThoseThatDo) {
  std::string known;
  for (const std::string& name : scenes::preset_names()) known += (known.empty() ? "" : ", ") + name;
  EXPECT_EQ(
      errors_of(scene_with(kMesh + R"("material": {"preset": "pancreas"})")),
      "t.json:2:41: error: /organs/0/material/preset: there is no preset \"pancreas\" (presets: " + known + ")\n");
  EXPECT_EQ(errors_of(scene_with(kMesh + R"("material": {"preset": "Kidny"})")),
            "t.json:2:41: error: /organs/0/material/preset: there is no preset \"Kidny\" (did you mean "
            "\"kidney\"?)\n");
}

TEST(BadInput, AMaterialWithoutPresetNamesEveryModulusThatIsMissing) {
  const std::string all = errors_of(scene_with(kMesh + R"("material": {"spring_kpa_per_mm": 15})"));
  for (const std::string key : {"kelvin_kpa_per_mm", "constraint_kpa_per_mm", "viscosity_kpa_s_per_mm",
                                "calibration_ball_radius_mm", "calibration_spacing_mm"})
    EXPECT_NE(all.find("t.json:2:30: error: /organs/0/material: the key \"" + key + "\" is missing"), std::string::npos)
        << all;
}

TEST(BadInput, AConstraintWeakerThanTheTriplesIsRefused) {
  EXPECT_EQ(errors_of(scene_with(kMesh + R"("material": {"preset": "liver", "constraint_kpa_per_mm": 7.4})")),
            "t.json:2:75: error: /organs/0/material/constraint_kpa_per_mm: got 7.4 kPa/mm, must be at least "
            "K1 K2 / (K1 + K2) "
            "= 7.5, which the triples already give\n");
}

TEST(BadInput, LayersEndDeeperAndDeeperAndHaveAMaterial) {
  const auto layers = [](const std::string& text) {
    return errors_of(scene_with(R"("layers": [)" + text + "], " + kMesh + kLiver));
  };
  const std::string skin = R"("material": {"preset": "skin"})";
  EXPECT_EQ(layers(R"({"to_depth_mm": 6, )" + skin + R"(}, {"to_depth_mm": 6.5, )" + skin + "}"), "no error");
  EXPECT_EQ(layers(R"({"to_depth_mm": 6, )" + skin + R"(}, {"to_depth_mm": 5.9, )" + skin + "}"),
            "t.json:2:80: error: /organs/0/layers/1/to_depth_mm: got 5.9, must be more than the 6 mm at "
            "which the layer "
            "above ends\n");
  EXPECT_EQ(layers(R"({"to_depth_mm": 0, )" + skin + "}"),
            "t.json:2:28: error: /organs/0/layers/0/to_depth_mm: got 0, must be in (0, 1000] mm\n");
  EXPECT_EQ(layers(R"({"to_depth_mm": 6})"),
            "t.json:2:12: error: /organs/0/layers/0: the key \"material\" is missing\n");
  EXPECT_EQ(layers(R"({"to_depth_mm": 6, "material": {"preset": "skim"}})"),
            "t.json:2:54: error: /organs/0/layers/0/material/preset: there is no preset \"skim\" (did you "
            "mean \"skin\"?)\n");
  EXPECT_NE(layers(R"({"to_depth_mm": 6, "material": {"preset": "skin", "constraint_kpa_per_mm": 1}})")
                .find("/organs/0/layers/0/material/constraint_kpa_per_mm: got 1 kPa/mm, must be at least"),
            std::string::npos);
}

TEST(BadInput, ARigWithTooFewSpheresIsRefused) {
  const std::string message = "got one sphere, a rig needs at least two that are neighbours\n";
  EXPECT_EQ(errors_of(scene_with(R"("rig": {"cells": [[0, 0, 0]]}, )" + kLiver)),
            "t.json:2:18: error: /organs/0/rig/cells: " + message);
  EXPECT_EQ(errors_of(scene_with(R"("rig": {"block": [1, 1, 1]}, )" + kLiver)),
            "t.json:2:18: error: /organs/0/rig/block: " + message);
  for (const std::string rig : {"{}", "{\"cells\": []}", R"({"block": [2, 2, 2], "cells": [[0, 0, 0], [1, 0, 0]]})"})
    EXPECT_EQ(errors_of(scene_with(R"("rig": )" + rig + ", " + kLiver)),
              "t.json:2:8: error: /organs/0/rig: must have exactly one of cells, block\n");
  EXPECT_NE(errors_of(scene_with(R"("rig": {"block": [0, 3, 3]}, )" + kLiver)).find("/organs/0/rig/block"),
            std::string::npos);
}

TEST(BadInput, CellsAreWholeAndGivenOnce) {
  EXPECT_EQ(errors_of(scene_with(R"("rig": {"cells": [[0, 0, 0], [1, 0, 0.5]]}, )" + kLiver)),
            "t.json:2:30: error: /organs/0/rig/cells/1: must be whole numbers\n");
  EXPECT_EQ(errors_of(scene_with(R"("rig": {"cells": [[0, 0, 0], [1, 0, 0], [0, 0, 0]]}, )" + kLiver)),
            "t.json:2:41: error: /organs/0/rig/cells/2: the cell is given more than once\n");
}

TEST(BadInput, GuidesNameSpheresOfTheRigAndAxes) {
  for (const std::string rig : {R"("cells": [[0, 0, 0], [1, 0, 0]])", R"("block": [2, 1, 1])"}) {
    const std::string all = errors_of(scene_with(
        R"("rig": {"guides": [{"cell": [2, 0, 0], "axes": "xw"}, {"cell": [0, -1, 0], "axes": "x"}, {"cell": [1, 0, 0], "axes": "xyz"}], )" +
        rig + "}, " + kLiver));
    EXPECT_EQ(all,
              "t.json:2:29: error: /organs/0/rig/guides/0/cell: is not one of the rig's cells\n"
              "t.json:2:48: error: /organs/0/rig/guides/0/axes: got \"xw\", must be letters of xyz\n"
              "t.json:2:64: error: /organs/0/rig/guides/1/cell: is not one of the rig's cells\n");
  }
}

TEST(BadInput, AnOrganIsEitherAMeshOrARig) {
  EXPECT_NE(errors_of(scene_with(kLiver)).find("/organs/0: must have exactly one of mesh, rig"), std::string::npos);
  EXPECT_NE(errors_of(scene_with(kMesh + R"("rig": {"block": [2, 2, 2]}, )" + kLiver))
                .find("/organs/0: must have exactly one of mesh, rig"),
            std::string::npos);
}

TEST(BadInput, AnAnchorHasExactlyOneRegionThatCanHoldSomething) {
  const auto anchors = [](const std::string& text) {
    return errors_of(scene_with(R"("anchors": [)" + text + "], " + kMesh + kLiver));
  };
  const std::string one = "must have exactly one of lowest_mm, box, sphere, plane\n";
  EXPECT_EQ(anchors("{}"), "t.json:2:13: error: /organs/0/anchors/0: got 0 of the keys, " + one);
  EXPECT_EQ(anchors(R"({"lowest_mm": 1, "sphere": {"centre_mm": [0, 0, 0], "radius_mm": 1}})"),
            "t.json:2:13: error: /organs/0/anchors/0: got 2 of the keys, " + one);
  EXPECT_EQ(anchors(R"({"plane": {"normal": [0, 0, 0], "point_mm": [0, 0, 0]}})"),
            "t.json:2:34: error: /organs/0/anchors/0/plane/normal: must not be zero, or shorter than 1e-9\n");
  EXPECT_EQ(anchors(R"({"box": {"min_mm": [0, 0, 3], "max_mm": [1, 1, 2]}})"),
            "t.json:2:21: error: /organs/0/anchors/0/box: min_mm must not be above max_mm in any coordinate\n");
}

TEST(BadInput, AToolHasTheKeysOfItsKind) {
  const auto tools = [](const std::string& text) {
    return errors_of(scene_with(kMesh + kLiver, ", \"tools\": [" + text + "]"));
  };
  EXPECT_EQ(tools(R"({"name": "b", "kind": "ball"})"),
            "t.json:3:13: error: /tools/0: a ball needs the key \"radius_mm\"\n");
  EXPECT_EQ(tools(R"({"name": "b", "kind": "ball", "radius_mm": 5, "blade_length_mm": 5})"),
            "t.json:3:78: error: /tools/0/blade_length_mm: only a scalpel has this key\n");
  EXPECT_EQ(tools(R"({"name": "b", "kind": "ball", "radius_mm": 5, "flank_height_mm": 5})"),
            "t.json:3:78: error: /tools/0/flank_height_mm: only a scalpel has this key\n");
  EXPECT_EQ(tools(R"({"name": "b", "kind": "pin"})"),
            "t.json:3:13: error: /tools/0: a pin needs the key \"holds_mm\"\n");
  EXPECT_EQ(tools(R"({"name": "b", "kind": "hook"})"),
            "t.json:3:35: error: /tools/0/kind: got the text \"hook\", must be one of \"ball\", \"scalpel\", "
            "\"pin\"\n");
}

TEST(BadInput, NamesAreTakenOnce) {
  EXPECT_EQ(
      errors_of(scene_with(kMesh + kLiver,
                           R"(, "probes": [{"name": "p", "at_mm": [0, 0, 0]}, {"name": "p", "at_mm": [1, 0, 0]}])")),
      "t.json:3:58: error: /probes/1/name: got \"p\", which is taken already\n");
}

TEST(BadInput, ACameraLooksSomewhereWithItsUpAcross) {
  const auto camera = [](const std::string& text) {
    return errors_of(scene_with(kMesh + kLiver, ", \"cameras\": [{\"name\": \"c\", " + text + "}]"));
  };
  EXPECT_NE(camera(R"("eye_mm": [1, 2, 3], "target_mm": [1, 2, 3])").find("must not be the same point as eye_mm"),
            std::string::npos);
  EXPECT_NE(camera(R"("eye_mm": [0, 0, 9], "target_mm": [0, 0, 3])").find("must not point along the line of sight"),
            std::string::npos);
  EXPECT_NE(
      camera(R"("eye_mm": [0, 9, 9], "target_mm": [0, 0, 3], "up": [0, 0, 0])").find("/cameras/0/up: must not be zero"),
      std::string::npos);
}

TEST(BadInput, AKeyThatIsGivenTwiceNamesTheFirstLine) {
  EXPECT_EQ(errors_of(scene_with(kMesh + kLiver, R"(, "name": "u")")),
            "t.json:3:3: error: /name: the key \"name\" is given twice (first in line 1)\n");
}

TEST(BadInput, AnOldOrForeignFileIsRefused) {
  EXPECT_NE(
      errors_of(R"({"format": "other", "version": 1})").find("/format: got the text \"other\", must be \"ctpm-scene\""),
      std::string::npos);
  EXPECT_EQ(errors_of(R"({"format": "ctpm-script", "version": 1, "steps": []})"),
            "t.json:1:12: error: /format: got the text \"ctpm-script\", must be \"ctpm-scene\" (this file holds a "
            "script)\n");
  EXPECT_NE(errors_of(R"({"format": "ctpm-scene", "version": 2})").find("/version: got the number 2, must be 1"),
            std::string::npos);
  EXPECT_EQ(errors_of("[]"), "t.json:1:1: error: /: got a list of 0, must be an object\n");
}

TEST(BadInput, OfVeryManyProblemsTheFirstAreListedAndTheOthersCounted) {
  std::string keys;
  for (int i = 0; i < 5000; ++i) keys += "\"key" + std::to_string(i) + "\": 1,\n";
  const Result<scenes::SceneText> scene = scenes::read_scene(scene_with(keys + kMesh + kLiver), "t.json");
  ASSERT_FALSE(scene);
  ASSERT_EQ(scene.errors().size(), 1001u);
  EXPECT_EQ(to_string(scene.errors().front()).find("t.json:2:1: error: /organs/0/key0: unknown key"), 0u);
  EXPECT_EQ(to_string(scene.errors().back()), "t.json: error: 4000 more errors are not listed (mend these first)");
}

}  // namespace
}  // namespace ctpm
