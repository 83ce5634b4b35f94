#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "scenes/scene_file.h"
#include "scenes/script.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = fs::path(CTPM_SOURCE_DIR) / "scenes";
constexpr double kTick = 1e-3;         // [s]
constexpr double kTouch = 0.5e-3;      // a ball may appear this deep in a surface that it is meant to touch [m]
constexpr double kWorthSeeing = 3e-3;  // a press or a cut that is less deep shows nothing [m]

std::string read_whole(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The mesh's vertices, from millimetres [m]. The shipped meshes are finer than any tool.
std::vector<Vec3> vertices_of(const fs::path& mesh) {
  std::vector<Vec3> vertices;
  std::ifstream file(mesh);
  std::string line, word;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    Vec3 p;
    if (words >> word && word == "v" && words >> p.x >> p.y >> p.z) vertices.push_back(0.001 * p);
  }
  return vertices;
}

/// The scene with whose name the script's begins.
std::string scene_of(std::string script) {
  while (!script.empty() && !fs::exists(kScenes / (script + ".json")))
    script.resize(script.find('-') == std::string::npos ? 0 : script.rfind('-'));
  return script;
}

struct Shipped {
  std::string name;
  scenes::SceneSpec scene;
  scenes::Script script;
  std::vector<Tool> tools;
  std::vector<Vec3> vertices;
};

std::vector<Shipped> shipped_scripts() {
  std::vector<Shipped> all;
  for (const auto& entry : fs::directory_iterator(kScenes / "scripts")) {
    if (entry.path().extension() != ".json") continue;
    const std::string name = entry.path().stem().string();
    const auto scene = scenes::load_scene((kScenes / (scene_of(name) + ".json")).string());
    if (!scene) {
      ADD_FAILURE() << name << ": " << to_string(scene.errors().front());
      continue;
    }
    std::vector<std::string> names;
    std::vector<Tool> tools;
    for (const scenes::ToolSpec& spec : scene->spec.tools) {
      names.push_back(spec.name);
      Tool& tool = tools.emplace_back();
      tool.name = spec.name, tool.kind = spec.kind;
      tool.radius = spec.radius.value_or(0), tool.blade_length = spec.blade_length.value_or(0);
    }
    const auto script =
        scenes::read_script(read_whole(entry.path()), entry.path().string(), names, scene->spec.hands.value_or(1));
    if (!script) {
      ADD_FAILURE() << to_string(script.errors().front());
      continue;
    }
    Shipped& shipped = all.emplace_back(Shipped{name, scene->spec, *script, tools, {}});
    for (const scenes::OrganSpec& organ : scene->spec.organs)
      for (const Vec3& vertex : vertices_of(kScenes / organ.mesh)) shipped.vertices.push_back(vertex);
  }
  std::sort(all.begin(), all.end(), [](const Shipped& a, const Shipped& b) { return a.name < b.name; });
  return all;
}

/// How deep a tool is in the organs at rest: a ball beyond its nearest vertex, a tip below the top around it
/// [m]. Negative: not in it.
double depth_of(const Shipped& shipped, const Hand& inputs) {
  const Tool& tool = shipped.tools[static_cast<std::size_t>(inputs.tool)];
  double depth = -1;
  for (const Vec3& p : shipped.vertices) {
    if (tool.kind == ToolKind::ball) {
      depth = std::max(depth, tool.radius - norm(p - inputs.position));
    } else if (std::hypot(p.x - inputs.position.x, p.y - inputs.position.y) < 4e-3) {
      depth = std::max(depth, p.z - inputs.position.z);
    }
  }
  return depth;
}

TEST(ShippedScripts, EachSceneHasOne) {
  std::vector<std::string> names;
  for (const Shipped& shipped : shipped_scripts()) names.push_back(scene_of(shipped.name));
  for (const std::string scene : {"liver", "kidney", "skin", "incision", "skin-incision", "two-organs", "two-hands"})
    EXPECT_NE(std::find(names.begin(), names.end(), scene), names.end()) << scene;
}

TEST(ShippedScripts, WrittenAndReadAgainTheyAreTheSame) {
  for (const Shipped& shipped : shipped_scripts()) {
    std::vector<std::string> names;
    for (const Tool& tool : shipped.tools) names.push_back(tool.name);
    const auto again =
        scenes::read_script(scenes::write_script(shipped.script), "again.json", names, shipped.scene.hands.value_or(1));
    ASSERT_TRUE(again) << shipped.name;
    EXPECT_EQ(*again, shipped.script) << shipped.name;
  }
}

TEST(ShippedScripts, ToolsAppearOutsideGoWellInAndLeave) {
  for (const Shipped& shipped : shipped_scripts()) {
    const scenes::ScriptPlayer player(shipped.script, shipped.tools, kTick);
    for (std::size_t hand = 0; hand < std::size_t(shipped.scene.hands.value_or(1)); ++hand) {
      double deepest = -1, last = 1;
      std::int32_t held = -1;
      // Every tenth tick: 0.8 mm of way at the most.
      for (std::int64_t tick = 0; tick < player.tick_count(); tick += 10) {
        const Hand inputs = player.at(tick).hand(hand);
        if (inputs.tool >= 0) {
          const double depth = depth_of(shipped, inputs);
          if (held != inputs.tool) {
            EXPECT_LT(depth, kTouch) << shipped.name << ": appears in the organ, tick " << tick;
          }
          deepest = std::max(deepest, depth), last = depth;
        }
        held = inputs.tool;
      }
      EXPECT_GT(deepest, kWorthSeeing) << shipped.name << ", hand " << hand;
      EXPECT_LT(last, 0) << shipped.name << ": still in the organ when it is put away";
      EXPECT_EQ(player.at(player.tick_count() - 1).hand(hand).tool, -1) << shipped.name;
    }
  }
}

}  // namespace
}  // namespace ctpm
