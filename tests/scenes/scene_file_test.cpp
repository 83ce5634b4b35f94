#include "scenes/scene_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "scenes/build_model.h"
#include "tests/scenes/shipped.h"

namespace ctpm {
namespace {

std::string shipped(const std::string& name) { return std::string(CTPM_SOURCE_DIR) + "/scenes/" + name; }

std::string scene_with(const std::string& organ_keys, const std::string& more = "") {
  return "{\n\"format\": \"ctpm-scene\", \"version\": 1, \"name\": \"test\",\n\"organs\": [{\"name\": \"a\", "
         "\"mesh\": \"a.obj\", " +
         organ_keys + "}]" + more + "\n}\n";
}

scenes::LoadOptions allowing_outside(bool allow) {
  scenes::LoadOptions options;
  options.allow_outside_paths = allow;
  return options;
}

/// The only error of a text, with its place.
std::string error_of(const std::string& text) {
  const Result<scenes::SceneText> scene = scenes::read_scene(text, "test.json");
  if (scene) return "no error";
  std::string all;
  for (const Error& error : scene.errors()) all += to_string(error) + "\n";
  return all;
}

TEST(SceneFile, EveryShippedSceneIsWrittenAndReadBackEqual) {
  ASSERT_GE(shipped_scenes().size(), 8u);
  for (const std::string& path : shipped_scenes()) {
    const Result<scenes::SceneText> scene = scenes::load_scene(path);
    ASSERT_TRUE(scene) << to_string(scene.errors().front());
    EXPECT_TRUE(scene->warnings.empty());
    const Result<scenes::SceneText> again = scenes::read_scene(scenes::write_scene(scene->spec), path);
    ASSERT_TRUE(again) << to_string(again.errors().front());
    EXPECT_TRUE(again->spec == scene->spec) << scenes::write_scene(scene->spec);
  }
}

TEST(SceneFile, AValueOutOfRangeIsNamedWithItsPlaceAndRange) {
  EXPECT_EQ(error_of(scene_with("\"material\": {\"preset\": \"liver\"}, \"fill\": {\"radius_mm\": -4}")),
            "test.json:3:98: error: /organs/0/fill/radius_mm: got -4, must be in [0.01, 100] mm\n");
}

TEST(SceneFile, AToolsPlaceIsJudged) {
  const auto with_tool = [](const std::string& keys) {
    return error_of(scene_with("\"material\": {\"preset\": \"liver\"}",
                               ",\n\"tools\": [{\"name\": \"b\", \"kind\": \"ball\", \"radius_mm\": 4" + keys + "}]"));
  };
  EXPECT_EQ(with_tool(", \"at_mm\": [0, 0, 9], \"pointing\": [1, 0, 0], \"facing\": [0, 1, 0]"), "no error");
  EXPECT_NE(with_tool(", \"pointing\": [1, 0, 0]").find("/tools/0/pointing: has no meaning without at_mm"),
            std::string::npos);
  EXPECT_NE(with_tool(", \"at_mm\": [0, 0, 9], \"pointing\": [0, 0, 0]").find("/tools/0/pointing"), std::string::npos);
  EXPECT_NE(with_tool(", \"at_mm\": [0, 0, 9], \"facing\": [0, 0, 2]").find("/tools/0/facing: must not be"),
            std::string::npos);
}

TEST(SceneFile, AnUnknownKeyNamesTheNearestOne) {
  EXPECT_NE(error_of(scene_with("\"material\": {\"preset\": \"liver\"}, \"modle\": \"ctpm\""))
                .find("did you mean \"model\"?"),
            std::string::npos);
}

TEST(SceneFile, AKeyWithTheWrongUnitNamesTheRightOne) {
  EXPECT_NE(error_of(scene_with("\"material\": {\"preset\": \"liver\"}, \"fill\": {\"radius_cm\": 0.4}"))
                .find("the key is \"radius_mm\""),
            std::string::npos);
}

TEST(SceneFile, AllErrorsComeInOneRunInTheOrderOfTheText) {
  const std::string all =
      error_of(scene_with("\"material\": {\"preset\": \"lever\"}", ", \"tick_s\": 5, \"gravity_m_per_s2\": [0, 0]"));
  EXPECT_NE(all.find("/tick_s"), std::string::npos);
  EXPECT_NE(all.find("/gravity_m_per_s2"), std::string::npos);
  EXPECT_NE(all.find("did you mean \"liver\"?"), std::string::npos);
}

TEST(SceneFile, ASyntaxErrorHasItsPlace) {
  EXPECT_EQ(error_of("{\n  \"format\": ,\n}").substr(0, 16), "test.json:2:13: ");
}

TEST(SceneFile, ASceneThatIsNotThereOrNotAFileIsRefused) {
  const Result<scenes::SceneText> missing = scenes::load_scene(shipped("nowhere.json"));
  ASSERT_FALSE(missing);
  EXPECT_EQ(to_string(missing.errors().front()), shipped("nowhere.json") + ": error: does not exist");
  const Result<scenes::SceneText> folder = scenes::load_scene(shipped("organs"));
  ASSERT_FALSE(folder);
  EXPECT_EQ(to_string(folder.errors().front()), shipped("organs") + ": error: is not a file");
}

/// Loads a scene in a folder of its own beside a file `outside.obj`, with `mesh` as its mesh.
Result<scenes::SceneText> load_with_mesh(const std::string& mesh, const scenes::LoadOptions& options = {}) {
  namespace fs = std::filesystem;
  const fs::path outer = fs::path(::testing::TempDir()) / ("scene_file_test_" + std::to_string(::getpid()));
  const fs::path folder = outer / "inner";
  fs::create_directories(folder / "folder.obj");
  std::ofstream(outer / "outside.obj") << "v 0 0 0\n";
  std::ofstream(folder / "inside.obj") << "v 0 0 0\n";
  std::ofstream(folder / "scene.json")
      << "{\"format\": \"ctpm-scene\", \"version\": 1, \"name\": \"t\", \"organs\": [\n{\"mesh\": \"" << mesh
      << "\", \"name\": \"a\", \"material\": {\"preset\": \"liver\"}}]}\n";
  Result<scenes::SceneText> scene = scenes::load_scene((folder / "scene.json").string(), options);
  fs::remove_all(outer);
  return scene;
}

TEST(SceneFile, AMeshIsInTheScenesFolderOrNamedAtItsPlace) {
  EXPECT_TRUE(load_with_mesh("inside.obj"));
  for (const auto& [mesh, message] : std::vector<std::pair<std::string, std::string>>{
           {"nowhere.obj", "there is no file \"nowhere.obj\" in the scene's folder"},
           {"folder.obj", "\"folder.obj\" is not a file"},
           {"../outside.obj", "got \"../outside.obj\", which leaves the scene's folder"},
           {"folder.obj/../../outside.obj", "which leaves the scene's folder"},
           {"/etc/hostname", "got \"/etc/hostname\", which leaves the scene's folder"}}) {
    const Result<scenes::SceneText> scene = load_with_mesh(mesh);
    ASSERT_FALSE(scene) << mesh;
    ASSERT_EQ(scene.errors().size(), 1u);
    EXPECT_TRUE(scene.errors()[0].where.ends_with("scene.json:2:10")) << scene.errors()[0].where;
    EXPECT_EQ(scene.errors()[0].message.find("/organs/0/mesh: "), 0u);
    EXPECT_NE(scene.errors()[0].message.find(message), std::string::npos) << scene.errors()[0].message;
  }
  EXPECT_TRUE(load_with_mesh("../outside.obj", allowing_outside(true)));
}

TEST(SceneFile, ALinkThatLeavesTheFolderIsRefusedLikeItsPlace) {
  namespace fs = std::filesystem;
  std::string pattern = (fs::temp_directory_path() / "ctpm-links-XXXXXX").string();
  ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
  const fs::path folder = pattern;
  fs::create_directories(folder / "inside/below");
  fs::copy_file(std::string(CTPM_SOURCE_DIR) + "/scenes/organs/skin.obj", folder / "outside.obj");
  fs::copy_file(folder / "outside.obj", folder / "inside/below/skin.obj");
  fs::create_symlink("../outside.obj", folder / "inside/linked.obj");
  fs::create_directory_symlink("..", folder / "inside/up");
  fs::create_symlink("below/skin.obj", folder / "inside/good.obj");
  const auto load = [&](const std::string& mesh, bool outside) {
    std::ofstream(folder / "inside/scene.json")
        << R"({"format": "ctpm-scene", "version": 1, "name": "a", "organs": [{"name": "a", "mesh": ")" << mesh
        << R"(", "fill": {"radius_mm": 3}, "material": {"preset": "skin"}}]})";
    return scenes::load_scene((folder / "inside/scene.json").string(), allowing_outside(outside));
  };
  EXPECT_TRUE(load("good.obj", false));
  for (const char* mesh : {"linked.obj", "up/outside.obj"}) {
    const Result<scenes::SceneText> scene = load(mesh, false);
    ASSERT_FALSE(scene) << mesh;
    EXPECT_NE(scene.errors()[0].message.find("is a link that leaves the scene's folder"), std::string::npos);
    EXPECT_TRUE(load(mesh, true)) << mesh;
  }
  fs::remove_all(folder);
}

TEST(SceneFile, ALongTextIsRefusedByItsSizeAndByItsValues) {
  const std::string spaces(17 << 20, ' ');
  const Result<scenes::SceneText> longer = scenes::read_scene("{}" + spaces, "long.json");
  ASSERT_FALSE(longer);
  EXPECT_EQ(to_string(longer.errors()[0]), "long.json: error: has 17825794 bytes, at most 16777216 are read");
  std::string lists = "[[]";
  for (int i = 0; i < 300000; ++i) lists += ",[]";
  const Result<scenes::SceneText> many = scenes::read_scene(lists + "]", "many.json");
  ASSERT_FALSE(many);
  EXPECT_EQ(to_string(many.errors()[0]), "many.json: error: holds more than 200000 values");
}

TEST(SceneFile, Cubic6InAnOrganIsWarnedOf) {
  const Result<scenes::SceneText> scene =
      scenes::read_scene(scene_with("\"material\": {\"preset\": \"liver\"}, \"lattice\": \"cubic-6\""), "test.json");
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->warnings.size(), 1u);
  EXPECT_NE(scene->warnings[0].message.find("no shear stiffness"), std::string::npos);
}

TEST(BuildModel, ARigBecomesItsSpheresAndElements) {
  const std::string text =
      R"({"format": "ctpm-scene", "version": 1, "name": "rig", "gravity_m_per_s2": [0, 0, 0],
    "organs": [{"name": "rig", "rig": {"cells": [[0,0,0],[1,0,0],[2,0,0],[3,0,0],[4,0,0]]}, "lattice": "cubic-6",
                "material": {"preset": "liver"}, "anchors": [{"sphere": {"centre_mm": [0,0,0], "radius_mm": 1}}]}],
    "tools": [{"name": "pin", "kind": "pin", "holds_mm": [24, 0, 0]}]})";
  const Result<scenes::SceneText> scene = scenes::read_scene(text, "rig.json");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  const std::vector<FilledOrgan> organs{scenes::fill_rig(scene->spec.organs[0])};
  const Result<scenes::BuiltScene> built = scenes::build_model(scene->spec, organs);
  ASSERT_TRUE(built) << to_string(built.errors().front());
  EXPECT_EQ(built->model.sphere_count(), 5u);
  EXPECT_EQ(built->model.axial.size(), 4u);
  EXPECT_EQ(built->model.constraints.size(), 1u);
  EXPECT_EQ(built->model.tools[0].sphere, 2);
  EXPECT_EQ(built->model.held_axes[0], kAnchored);
  EXPECT_EQ(built->model.held_axes[1], 0);
}

TEST(BuildModel, AnAnchorThatHoldsNoSphereIsAnError) {
  const std::string text = R"({"format": "ctpm-scene", "version": 1, "name": "rig",
    "organs": [{"name": "rig", "rig": {"block": [3, 3, 3]}, "material": {"preset": "liver"},
                "anchors": [{"sphere": {"centre_mm": [900,0,0], "radius_mm": 1}}]}]})";
  const Result<scenes::SceneText> scene = scenes::read_scene(text, "rig.json");
  ASSERT_TRUE(scene);
  const std::vector<FilledOrgan> organs{scenes::fill_rig(scene->spec.organs[0])};
  const Result<scenes::BuiltScene> built = scenes::build_model(scene->spec, organs);
  ASSERT_FALSE(built);
  EXPECT_EQ(built.errors().front().where, "/organs/0/anchors/0");
}

TEST(ReadScene, ForbiddenZonesAreReadAndChangeNoModel) {
  const auto scene_of = [](const std::string& zones) {
    return scenes::read_scene(R"({"format": "ctpm-scene", "version": 1, "name": "rig", "organs": [{"name": "rig",
      "rig": {"block": [3, 3, 3]}, "material": {"preset": "liver"}}], "forbidden": [)" +
                                  zones + "]}",
                              "rig.json");
  };
  const auto scene = scene_of(R"({"name": "vessel", "sphere": {"centre_mm": [0, 0, 10], "radius_mm": 5}},
    {"name": "below", "plane": {"point_mm": [0, 0, 0], "normal": [0, 0, 1]}},
    {"name": "box", "box": {"min_mm": [1, 1, 1], "max_mm": [2, 2, 2]}})");
  ASSERT_TRUE(scene) << to_string(scene.errors().front());
  const std::vector<scenes::ZoneSpec>& zones = scene->spec.forbidden;
  ASSERT_EQ(zones.size(), 3u);
  EXPECT_TRUE(scenes::is_in(zones[0], {0, 0, 0.0149}));
  EXPECT_FALSE(scenes::is_in(zones[0], {0, 0, 0.0151}));
  EXPECT_TRUE(scenes::is_in(zones[1], {1, 1, -0.1}));
  EXPECT_FALSE(scenes::is_in(zones[1], {1, 1, 0.1}));
  EXPECT_TRUE(scenes::is_in(zones[2], {0.0015, 0.0015, 0.002}));
  EXPECT_FALSE(scenes::is_in(zones[2], {0.0015, 0.0015, 0.0021}));
  // A ball, by its surface.
  EXPECT_TRUE(scenes::is_in(zones[0], {0, 0, 0.0249}, 0.010));
  EXPECT_FALSE(scenes::is_in(zones[0], {0, 0, 0.0251}, 0.010));
  EXPECT_TRUE(scenes::is_in(zones[1], {1, 1, 0.009}, 0.010));
  EXPECT_FALSE(scenes::is_in(zones[1], {1, 1, 0.011}, 0.010));
  EXPECT_TRUE(scenes::is_in(zones[2], {0.003, 0.003, 0.003}, 0.00174));  // from a corner: sqrt(3) mm
  EXPECT_FALSE(scenes::is_in(zones[2], {0.003, 0.003, 0.003}, 0.00173));
  // A line that goes through, with both ends outside, and one that passes beside.
  EXPECT_TRUE(scenes::is_in(zones[0], {-0.1, 0.0049, 0.01}, {0.1, 0.0049, 0.01}));
  EXPECT_FALSE(scenes::is_in(zones[0], {-0.1, 0.0051, 0.01}, {0.1, 0.0051, 0.01}));
  EXPECT_FALSE(scenes::is_in(zones[0], {-0.1, 0.0049, 0.01}, {-0.01, 0.0049, 0.01})) << "it ends before";
  EXPECT_TRUE(scenes::is_in(zones[1], {0, 0, 0.1}, {0, 0, -0.1}));
  EXPECT_FALSE(scenes::is_in(zones[1], {0, 0, 0.1}, {5, 0, 0.05}));
  EXPECT_TRUE(scenes::is_in(zones[2], {0, 0.0015, 0.0015}, {0.003, 0.0015, 0.0015}));
  EXPECT_TRUE(scenes::is_in(zones[2], {0, 0, 0}, {0.003, 0.003, 0.003}));
  EXPECT_FALSE(scenes::is_in(zones[2], {0, 0.0021, 0.0015}, {0.003, 0.0021, 0.0015}));
  EXPECT_FALSE(scenes::is_in(zones[2], {0, 0.0018, 0.0015}, {0.0018, 0.0036, 0.0015})) << "past an edge";
  const auto again = scenes::read_scene(scenes::write_scene(scene->spec), "again.json");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->spec, scene->spec);
  const auto broken =
      scene_of(R"({"name": "a"}, {"name": "a", "plane": {"point_mm": [0, 0, 0], "normal": [0, 0, 0]}})");
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.errors().size(), 3u) << "no place, a name twice, no direction";
}

}  // namespace
}  // namespace ctpm
