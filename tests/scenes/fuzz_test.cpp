// Scene and script text that was cut, flipped and pieced together by chance: reading it never crashes and
// never hangs, and what is refused has a place. Sanitizer builds run the same cases.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/anchors.h"
#include "scenes/build_model.h"
#include "scenes/scene_file.h"
#include "scenes/schema.h"
#include "scenes/script.h"
#include "tests/scenes/schema_check.h"

namespace ctpm {
namespace {

constexpr int kRounds = 20000;

/// A small generator of our own (xorshift), so that every machine runs the same cases.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t limit) {
    state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
    return std::size_t(state_ % limit);
  }

 private:
  std::uint64_t state_;
};

/// Every key of the format, so that damage reaches every reader.
const std::string kScene =
    R"({"format": "ctpm-scene", "version": 1, "name": "s", "gravity_m_per_s2": [0, 0, -9.81], "tick_s": 1e-3, "settle_s": 1,
 "organs": [{"name": "a", "mesh": "a.obj", "mesh_unit": "mm", "model": "ctpm", "lattice": "cubic-18", "softening": true,
   "fill": {"radius_mm": 4, "gap_mm": 4}, "material": {"preset": "liver", "stiffness_scale": 0.3, "spring_kpa_per_mm": 15.5},
   "layers": [{"to_depth_mm": 6.1, "material": {"preset": "skin"}}, {"to_depth_mm": 9, "material": {"preset": "kidney", "density_kg_per_m3": 1100}}],
   "anchors": [{"lowest_mm": 8}, {"box": {"min_mm": [0, 0, 0], "max_mm": [1, 2, 3]}},
     {"sphere": {"centre_mm": [1, 2, 3], "radius_mm": 4}}, {"plane": {"point_mm": [0, 0, 0], "normal": [0, 0, 1]}}],
   "damage_depth_mm": 12, "damage_force_n": 3, "inversion_resistance": 5, "surface_color": [0.5, 0.1, 0.1], "inner_color": [0.5, 0, 0]},
  {"name": "b\u00e9\n", "rig": {"cells": [[0, 0, 0], [1, 0, 0]], "guides": [{"cell": [0, 0, 0], "axes": "xy"}]}, "material": {"preset": "skin"}},
  {"name": "c", "rig": {"block": [3, 3, 3]}, "material": {"preset": "kidney-pa-s"}}],
 "tools": [{"name": "ball", "kind": "ball", "radius_mm": 6}, {"name": "pin", "kind": "pin", "holds_mm": [1, 2, 3]},
   {"name": "knife", "kind": "scalpel", "blade_length_mm": 50, "blade_reach_mm": 8, "flank_height_mm": 5, "blade_thickness_mm": 2}],
 "contact_stiffness_n_per_m": 500, "contact_friction": 0.2, "contact_damping_s_per_m": 40, "cut_face_stiffening": 5,
 "loads": [{"at_mm": [1, 2, 3], "force_n": [0, 0, 1], "start_s": 1, "ramp_s": 2}], "probes": [{"name": "p", "at_mm": [1, 2, 3]}],
 "solver": {"tolerance": 1e-5, "velocity_floor_mm_per_s": 1e-3, "velocity_enough_mm_per_s": 2e-3, "max_iterations": 100, "substeps": 2, "sleep_below_mm_per_s": 0.01},
 "cameras": [{"name": "front", "eye_mm": [1, 2, 3], "target_mm": [0, 0, 0], "up": [0, 0, 1], "field_of_view_deg": 30}]})";

const std::string kScript = R"({"format": "ctpm-script", "version": 1, "steps": [
 {"take": {"tool": "ball", "at_mm": [0, 0, 50], "pointing": [0, 0, -1]}}, {"move": {"to_mm": [1, 2, 3], "speed_mm_per_s": 20}},
 {"press": {"distance_mm": 5, "direction": [0, 0, -1], "speed_mm_per_s": 10}}, {"wait_s": 0.5},
 {"release": {"distance_mm": 5, "speed_mm_per_s": 10}}, {"take": {"tool": "knife", "at_mm": [0, 0, 50]}},
 {"cut": {"path_mm": [[0, 0, 5], [5, 0, 5]], "speed_mm_per_s": 30}}, {"put_away": true}]})";

std::string damaged(const std::string& text, Chance& chance) {
  static const std::vector<std::string> pieces{"1e308",
                                               "-1e-308",
                                               "1e-400",
                                               "1e999",
                                               "0",
                                               "-0",
                                               "null",
                                               "true",
                                               "\"\"",
                                               "[]",
                                               "{}",
                                               "[",
                                               "]",
                                               "{",
                                               "}",
                                               ",",
                                               ":",
                                               "\"",
                                               "\\",
                                               "\\u0000",
                                               "\\ud800",
                                               std::string(1, '\0'),
                                               "\xEF\xBB\xBF",
                                               "\xFF",
                                               "\xC3",
                                               "999999999999999999999999999999",
                                               "[[[[[[[[[[",
                                               "\"preset\"",
                                               "1e99999999999999999999"};
  std::string result = text;
  for (std::size_t edits = 1 + chance.below(4); edits > 0 && !result.empty(); --edits) {
    const std::size_t at = chance.below(result.size()), length = chance.below(12);
    switch (chance.below(5)) {
      case 0:
        result.resize(at);
        break;
      case 1:
        result[at] = static_cast<char>(static_cast<unsigned char>(result[at]) ^ (1u << chance.below(8)));
        break;
      case 2:
        result.erase(at, length);
        break;
      case 3:
        result.insert(at, pieces[chance.below(pieces.size())]);
        break;
      default:
        result.replace(at, length, pieces[chance.below(pieces.size())]);
    }
  }
  return result;
}

void expect_placed(const Errors& errors, const std::string& file_name, const std::string& text) {
  for (const Error& error : errors) {
    ASSERT_EQ(error.where.find(file_name), 0u) << error.where << "\n" << text;
    ASSERT_FALSE(error.message.empty()) << text;
  }
}

TEST(Fuzz, DamagedScenesAreReadOrRefusedWithAPlace) {
  ASSERT_FALSE(scenes::read_scene(kScene, "s.json"));  // the line break in a name
  Chance chance(1);
  const SchemaCheck schema(scenes::scene_schema());
  std::string whole = kScene;
  whole.erase(whole.find("\\n"), 2);
  ASSERT_TRUE(scenes::read_scene(whole, "s.json")) << to_string(scenes::read_scene(whole, "s.json").errors().front());
  int refused = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::string text = damaged(whole, chance);
    const Result<scenes::SceneText> scene = scenes::read_scene(text, "s.json");
    if (scene) {
      // What is accepted can be written, and read again as the same.
      const Result<scenes::SceneText> again = scenes::read_scene(scenes::write_scene(scene->spec), "again.json");
      ASSERT_TRUE(again) << to_string(again.errors().front()) << "\n" << text;
      ASSERT_TRUE(again->spec == scene->spec) << text;
      // What the reader accepts, the schema accepts.
      ASSERT_EQ(schema.problem_of(text), "") << text;
    } else {
      ++refused;
      expect_placed(scene.errors(), "s.json", text);
    }
  }
  EXPECT_GT(refused, kRounds / 2);
  EXPECT_LT(refused, kRounds);
}

TEST(Fuzz, DamagedScenesAreJudgedAsFarAsTheyAreGood) {
  Chance chance(3);
  std::string whole = kScene;
  whole.erase(whole.find("\\n"), 2);
  int placed = 0;
  for (int round = 0; round < kRounds / 10; ++round) {
    const std::string text = damaged(whole, chance);
    Result<scenes::SceneDraft> draft = scenes::read_draft(text, "s.json");
    if (!draft) continue;
    std::vector<FilledOrgan> organs;
    for (std::size_t i = 0; i < draft->scene.spec.organs.size(); ++i) {
      const scenes::OrganSpec& organ = draft->scene.spec.organs[i];
      const bool is_small = organ.rig && (!organ.rig->block || norm(*organ.rig->block) < 10);
      organs.push_back(is_small && scenes::can_be_filled(draft->problems, i) ? scenes::fill_rig(organ) : FilledOrgan{});
    }
    const std::optional<scenes::BuiltScene> built = scenes::build_model(draft->scene.spec, organs, draft->problems);
    ASSERT_EQ(built.has_value(), draft->problems.is_empty()) << text;
    expect_placed(draft->problems.errors(), "s.json:", text);
    placed += int(draft->problems.errors().size());
  }
  EXPECT_GT(placed, kRounds / 100);
}

TEST(Fuzz, DamagedScriptsAreReadAndPlayedOrRefusedWithAPlace) {
  const std::vector<std::string> names{"ball", "knife"};
  std::vector<Tool> tools(2);
  tools[0].name = "ball", tools[1].name = "knife";
  ASSERT_TRUE(scenes::read_script(kScript, "s.json", names));
  Chance chance(2);
  const SchemaCheck schema(scenes::script_schema());
  int refused = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::string text = damaged(kScript, chance);
    const Result<scenes::Script> script = scenes::read_script(text, "s.json", names);
    if (script) {
      const Result<scenes::Script> again = scenes::read_script(scenes::write_script(*script), "again.json", names);
      ASSERT_TRUE(again) << to_string(again.errors().front()) << "\n" << text;
      ASSERT_TRUE(*again == *script) << text;
      ASSERT_EQ(schema.problem_of(text), "") << text;
      const scenes::ScriptPlayer player(*script, tools, 1e-3);
      ASSERT_GT(player.tick_count(), 0) << text;
      for (const std::int64_t tick : {std::int64_t(0), player.tick_count() / 3, player.tick_count() - 1}) {
        ASSERT_TRUE(is_finite(player.at(tick).position)) << text;
        const Quat q = player.at(tick).world_from_tool;
        ASSERT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-12) << text;
      }
    } else {
      ++refused;
      expect_placed(script.errors(), "s.json", text);
    }
  }
  EXPECT_GT(refused, kRounds / 2);
  EXPECT_LT(refused, kRounds);
}

TEST(Fuzz, EveryPrefixOfASceneIsRefused) {
  for (std::size_t length = 0; length < kScene.size(); ++length)
    ASSERT_FALSE(scenes::read_scene(std::string_view(kScene).substr(0, length), "s.json")) << length;
}

TEST(Fuzz, RandomBytesAreNeitherScenesNorAnchors) {
  Chance chance(3);
  for (int round = 0; round < kRounds; ++round) {
    std::string text;
    for (std::size_t i = chance.below(60); i > 0; --i) text += static_cast<char>(chance.below(256));
    ASSERT_FALSE(scenes::read_scene(text, "s.json"));
    ASSERT_FALSE(scenes::parse_anchor("box:" + text));
  }
}

/// Seconds that it takes to read a text.
double time_to_refuse(const std::string& text) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(scenes::read_scene(text, "s.json"));
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Fuzz, LongBadTextIsRefusedInTimeThatGrowsWithItsLength) {
  // About 0.1 s each in a release build; a search of every item in every other takes minutes.
  constexpr double kPatience = 20;  // [s], for slow machines and sanitizers
  const std::string head =
      R"({"format": "ctpm-scene", "version": 1, "name": "s", "organs": [{"name": "a", "material": {"preset": "liver"}, "rig": {"cells": [)";
  std::string cells = head, keys = "{", anchors = head + "[0, 0, 0], [1, 0, 0]]}, \"anchors\": [{}";
  for (int i = 0; i < 100000; ++i) {
    cells += "[" + std::to_string(i % 300) + ", " + std::to_string(i % 299) + ", 0], ";
    keys += "\"a" + std::to_string(i) + "\": 1, ";
    anchors += ", {\"plane\": {\"point_mm\": [0, 0, 0], \"normal\": [0, 0, 0]}}";
  }
  EXPECT_LT(time_to_refuse(cells + "[0, 0, 0]]}}]}"), kPatience);
  EXPECT_LT(time_to_refuse(keys + "\"z\": 1}"), kPatience);
  EXPECT_LT(time_to_refuse(anchors + "]}]}"), kPatience);
  EXPECT_LT(time_to_refuse(std::string(1000000, '[')), kPatience);
  EXPECT_LT(time_to_refuse("{\"" + std::string(1000000, 'x') + "\": 1}"), kPatience);
}

}  // namespace
}  // namespace ctpm
