#include "scenes/script.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scenes/build_model.h"
#include "scenes/scene_file.h"

namespace ctpm {
namespace {

const std::vector<std::string> kTools{"ball", "scalpel"};
constexpr double kTick = 1e-3;  // [s]

std::vector<Tool> tools_of_model() {
  std::vector<Tool> tools(2);
  tools[0].name = "ball", tools[0].kind = ToolKind::ball, tools[0].radius = 0.01;
  tools[1].name = "scalpel", tools[1].kind = ToolKind::scalpel, tools[1].blade_length = 0.05;
  return tools;
}

/// A script of these steps, the first of them in line 2 at column 1.
std::string script_of(const std::string& steps) {
  return "{\"format\": \"ctpm-script\", \"version\": 1, \"steps\": [\n" + steps + "\n]}\n";
}

const std::string kTake = R"({"take": {"tool": "ball", "at_mm": [0, 0, 50]}})";

/// Every error of a text, one a line.
std::string errors_of(const std::string& text) {
  const Result<scenes::Script> script = scenes::read_script(text, "s.json", kTools);
  if (script) return "no error";
  std::string all;
  for (const Error& error : script.errors()) all += to_string(error) + "\n";
  return all;
}

scenes::Script read_good(const std::string& steps) {
  const Result<scenes::Script> script = scenes::read_script(script_of(steps), "s.json", kTools);
  if (!script) {
    ADD_FAILURE() << to_string(script.errors().front());
    return {};
  }
  return *script;
}

TEST(ReadScript, AToolThatTheSceneDoesNotHaveIsNamedWithThoseItHas) {
  EXPECT_EQ(errors_of(script_of(R"({"take": {"tool": "spoon", "at_mm": [0, 0, 50]}})")),
            "s.json:2:19: error: /steps/0/take/tool: the scene has no tool \"spoon\" (its tools: ball, scalpel)\n");
}

TEST(ReadScript, AStepBeforeAnyToolIsTakenHasNoHand) {
  for (const std::string step : {R"({"move": {"to_mm": [0, 0, 0], "speed_mm_per_s": 10}})",
                                 R"({"press": {"distance_mm": 5, "speed_mm_per_s": 10}})",
                                 R"({"release": {"distance_mm": 5, "speed_mm_per_s": 10}})",
                                 R"({"cut": {"path_mm": [[0, 0, 0]], "speed_mm_per_s": 10}})"}) {
    const std::string expected = "s.json:2:1: error: /steps/0: there is no tool in the hand here (take one first)\n";
    EXPECT_EQ(errors_of(script_of(step)), expected);
    EXPECT_NE(errors_of(script_of(kTake + ",\n{\"put_away\": true},\n" + step))
                  .find("s.json:4:1: error: /steps/2: there is no tool"),
              std::string::npos);
  }
}

TEST(ReadScript, AStepDoesExactlyOneThing) {
  EXPECT_EQ(errors_of(script_of(kTake + ",\n" + R"({"wait_s": 1, "put_away": true})")),
            "s.json:3:1: error: /steps/1: got 2 of the keys, must have exactly one of take, move, press, "
            "release, cut, "
            "wait_s, put_away\n");
  EXPECT_EQ(errors_of(script_of("{}")),
            "s.json:2:1: error: /steps/0: got 0 of the keys, must have exactly one of take, move, press, "
            "release, cut, "
            "wait_s, put_away\n");
}

TEST(ReadScript, AnUnknownKeyIsPlacedAndTheNearestNamed) {
  const std::string all = errors_of(script_of(R"({"take": {"tool": "ball", "at_cm": [0, 0, 5]}})"));
  EXPECT_NE(all.find("s.json:2:27: error: /steps/0/take/at_cm: unknown key \"at_cm\" (the key is \"at_mm\": "
                     "the unit is part of it)"),
            std::string::npos)
      << all;
  EXPECT_NE(all.find("s.json:2:10: error: /steps/0/take: the key \"at_mm\" is missing"), std::string::npos) << all;
}

TEST(ReadScript, ADirectionWithoutLengthIsRefusedWhereItStands) {
  for (const std::string zero : {"[0, 0, 0]", "[0, -0.0, 1e-170]", "[1e-320, 0, 0]"}) {
    const std::string message = "must not be zero, or shorter than 1e-9\n";
    EXPECT_EQ(errors_of(script_of(R"({"take": {"tool": "ball", "at_mm": [0, 0, 5], "pointing": )" + zero + "}}")),
              "s.json:2:59: error: /steps/0/take/pointing: " + message);
    EXPECT_EQ(errors_of(script_of(kTake + ",\n{\"press\": {\"direction\": " + zero +
                                  R"(, "distance_mm": 5, "speed_mm_per_s": 10}})")),
              "s.json:3:25: error: /steps/1/press/direction: " + message);
    EXPECT_EQ(errors_of(script_of(kTake + ",\n{\"release\": {\"direction\": " + zero +
                                  R"(, "distance_mm": 5, "speed_mm_per_s": 10}})")),
              "s.json:3:27: error: /steps/1/release/direction: " + message);
  }
}

TEST(ReadScript, ASpeedOutOfRangeIsRefusedWhereItStands) {
  for (const std::string speed : {"0", "-5", "1e-300", "10001", "1e300"}) {
    EXPECT_EQ(errors_of(script_of(kTake + ",\n{\"move\": {\"speed_mm_per_s\": " + speed + R"(, "to_mm": [0, 0, 0]}})")),
              "s.json:3:29: error: /steps/1/move/speed_mm_per_s: got " + speed + ", must be in [0.001, 10000] mm/s\n");
  }
  EXPECT_NE(errors_of(script_of(kTake + ",\n" + R"({"cut": {"speed_mm_per_s": "fast", "path_mm": []}})"))
                .find("got the text \"fast\", must be a number"),
            std::string::npos);
}

TEST(ReadScript, AScriptWithoutStepsOrAPathWithoutPointsIsRefused) {
  EXPECT_NE(errors_of(script_of("")).find("/steps: got a list of 0, must have at least 1"), std::string::npos);
  EXPECT_NE(errors_of(script_of(kTake + R"(, {"cut": {"speed_mm_per_s": 5, "path_mm": []}})"))
                .find("/path_mm: got a list of 0, must have at least 1"),
            std::string::npos);
}

TEST(ReadScript, PuttingAwayIsAlwaysTrue) {
  EXPECT_EQ(errors_of(script_of(R"({"put_away": false})")), "s.json:2:14: error: /steps/0/put_away: must be true\n");
}

/// Every kind of step, in numbers that are not exact in binary.
const std::string kEveryStep = R"(
  {"take": {"tool": "scalpel", "at_mm": [1.1, -2.7, 50.3], "pointing": [0.1, 0.2, -0.7]}},
  {"move": {"to_mm": [3.3, 4.1, 20.9], "speed_mm_per_s": 12.3}},
  {"press": {"distance_mm": 7.7, "direction": [0.3, 0, -1], "speed_mm_per_s": 9.1, "until_force_n": 1.7}},
  {"release": {"distance_mm": 3.3, "speed_mm_per_s": 33.3}},
  {"wait_s": 0.35},
  {"cut": {"path_mm": [[1.7, 2.9, 10.1], [5.3, 2.9, 10.1], [9.7, 3.1, 9.3]], "speed_mm_per_s": 30.7}},
  {"cut": {"path_mm": [[1.7, 2.9, 10.1], [5.3, 2.9, 10.1], [9.7, 3.1, 9.3]], "speed_mm_per_s": 30.7, "smooth": true,
           "turns": true}},
  {"put_away": true}, {"wait_s": 0.1})";

TEST(WriteScript, WhatIsWrittenIsReadBackEqual) {
  const scenes::Script script = read_good(kEveryStep);
  ASSERT_EQ(script.steps.size(), 9u);
  const Result<scenes::Script> again = scenes::read_script(scenes::write_script(script), "again.json", kTools);
  ASSERT_TRUE(again) << to_string(again.errors().front());
  EXPECT_TRUE(*again == script) << scenes::write_script(script);
  EXPECT_EQ(scenes::write_script(*again), scenes::write_script(script));
}

TEST(WriteScript, AReleaseLeavesUpwardsUnlessAnotherDirectionIsWritten) {
  const scenes::Script script = read_good(kTake + R"(, {"release": {"distance_mm": 3, "speed_mm_per_s": 30}})");
  EXPECT_EQ(script.steps.at(1).release.value().direction, (Vec3{0, 0, 1}));
}

/// Positions of the tool from `first` on, as long as it is in the hand.
std::vector<Vec3> way_in_hand(const scenes::ScriptPlayer& player, std::int64_t first = 0) {
  std::vector<Vec3> way;
  for (std::int64_t tick = first; tick < player.tick_count() && player.at(tick).tool >= 0; ++tick)
    way.push_back(player.at(tick).position);
  return way;
}

TEST(ScriptPlayer, NeverMovesFasterThanTheStepSays) {
  const scenes::Script script = read_good(kEveryStep);
  const scenes::ScriptPlayer player(script, tools_of_model(), kTick);
  const std::vector<Vec3> way = way_in_hand(player);
  ASSERT_GT(way.size(), 100u);
  double largest = 0;
  for (std::size_t i = 1; i < way.size(); ++i) largest = std::max(largest, norm(way[i] - way[i - 1]));
  constexpr double kFastest = 33.3e-3;  // [m/s] of the steps above
  EXPECT_LE(largest, kFastest * kTick * (1 + 1e-12));
  EXPECT_GE(largest, 0.9 * kFastest * kTick);
}

TEST(ScriptPlayer, ReachesItsSpeedAndKeepsItInBetween) {
  const scenes::Script script = read_good(kTake + R"(, {"move": {"to_mm": [100, 0, 50], "speed_mm_per_s": 50}})");
  const scenes::ScriptPlayer player(script, tools_of_model(), kTick);
  const std::int64_t middle = player.tick_count() / 2;
  for (std::int64_t tick = middle - 500; tick < middle + 500; ++tick)
    ASSERT_NEAR(norm(player.at(tick + 1).position - player.at(tick).position), 50e-3 * kTick, 1e-15);
}

TEST(ScriptPlayer, EveryStretchStartsAndEndsAtRest) {
  const scenes::Script script = read_good(kTake + R"(, {"move": {"to_mm": [100, 0, 50], "speed_mm_per_s": 50}},
                                               {"move": {"to_mm": [100, 80, 50], "speed_mm_per_s": 20}})");
  const scenes::ScriptPlayer player(script, tools_of_model(), kTick);
  // After a share t of the time the speed is about 3 (t / 0.2)^2 of the full one: a thousandth in the first
  // tick of 2500.
  const auto speed = [&](std::int64_t tick) {
    return norm(player.at(tick).position - player.at(tick - 1).position) / kTick;
  };
  const std::int64_t turn = 1 + 2500;  // one tick to take the tool, 100 mm / 50 mm/s / 0.8
  EXPECT_LT(speed(1), 1e-3 * 50e-3);
  EXPECT_LT(speed(turn - 1), 1e-3 * 50e-3);
  EXPECT_LT(speed(turn), 1e-3 * 20e-3);
  EXPECT_LT(speed(player.tick_count() - 1), 1e-3 * 20e-3);
  EXPECT_EQ(player.at(turn - 1).position, (Vec3{0.1, 0, 0.05}));
  EXPECT_EQ(player.at(player.tick_count() - 1).position, (Vec3{0.1, 0.08, 0.05}));
  // No jump in acceleration either: the speed changes from tick to tick by little, across the turn as well.
  for (std::int64_t tick = 2; tick < player.tick_count(); ++tick)
    ASSERT_LT(std::abs(speed(tick) - speed(tick - 1)), 50e-3 * 1.5 / 0.2 / 2500 * 1.01) << "tick " << tick;
}

TEST(ScriptPlayer, LastsAsLongAsItsSteps) {
  const auto ticks = [](const std::string& steps) {
    return scenes::ScriptPlayer(read_good(steps), tools_of_model(), kTick).tick_count();
  };
  EXPECT_EQ(ticks(kTake), 1);
  EXPECT_EQ(ticks(kTake + R"(, {"wait_s": 0.5})"), 501);
  // Rise and fall take a fifth of the time each and half of the way that full speed would go in them.
  EXPECT_EQ(ticks(kTake + R"(, {"move": {"to_mm": [0, 0, 130], "speed_mm_per_s": 50}})"), 1 + 2000);
  EXPECT_EQ(
      ticks(
          kTake +
          R"(, {"press": {"distance_mm": 8, "speed_mm_per_s": 4}}, {"release": {"distance_mm": 8, "speed_mm_per_s": 8}})"),
      1 + 2500 + 1250);
}

TEST(ScriptPlayer, IsAPureFunctionOfTheTick) {
  const scenes::Script script = read_good(kEveryStep);
  const scenes::ScriptPlayer player(script, tools_of_model(), kTick), other(script, tools_of_model(), kTick);
  std::vector<Inputs> forwards;
  for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) forwards.push_back(player.at(tick));
  for (std::int64_t tick = player.tick_count() - 1; tick >= 0; --tick) {
    ASSERT_EQ(player.at(tick), forwards[std::size_t(tick)]);
    ASSERT_EQ(other.at(tick), forwards[std::size_t(tick)]);
  }
}

TEST(ScriptPlayer, StaysAsItIsAfterTheEnd) {
  const scenes::Script script = read_good(kTake + R"(, {"move": {"to_mm": [7, 0, 50], "speed_mm_per_s": 50}})");
  const scenes::ScriptPlayer player(script, tools_of_model(), kTick);
  const Inputs last = player.at(player.tick_count() - 1);
  EXPECT_EQ(last.position, (Vec3{0.007, 0, 0.05}));
  for (const std::int64_t later : {std::int64_t(0), std::int64_t(1), std::int64_t(1) << 60})
    EXPECT_EQ(player.at(player.tick_count() + later), last);
}

TEST(ScriptPlayer, TurnsMinusZOntoPointing) {
  // To a few roundings, next to straight up as well, where the shortest turn loses its axis.
  constexpr double kRounding = 1e-15;
  for (const Vec3 pointing :
       {Vec3{0, 0, -1}, Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, -3, 0}, Vec3{1, 2, -3}, Vec3{-1, 5, 4}, Vec3{1e-4, 0, 1},
        Vec3{0, -1e-6, 1}, Vec3{3e-9, 4e-9, 1}, Vec3{1e-30, 0, 1}, Vec3{1e-130, 0, 1}, Vec3{1e-5, 1e-5, -1},
        Vec3{2e-9, 0, 0}, Vec3{0, 0, 1e6}}) {
    scenes::Script script;
    script.steps.emplace_back().take = scenes::ScriptStep::Take{"ball", {}, pointing, {}};
    const Quat q = scenes::ScriptPlayer(script, tools_of_model(), kTick).at(0).world_from_tool;
    EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, kRounding);
    EXPECT_NEAR(norm(rotate(q, {0, 0, -1}) - pointing / norm(pointing)), 0, kRounding)
        << pointing.x << " " << pointing.y << " " << pointing.z;
  }
}

TEST(ScriptPlayer, HoldsTheToolsThatTheStepsSay) {
  const scenes::Script script = read_good(kTake + R"(, {"wait_s": 0.01}, {"put_away": true}, {"wait_s": 0.01},
                                               {"take": {"tool": "scalpel", "at_mm": [1, 2, 3]}})");
  const scenes::ScriptPlayer player(script, tools_of_model(), kTick);
  ASSERT_EQ(player.tick_count(), 1 + 10 + 1 + 10 + 1);
  EXPECT_EQ(player.at(10).tool, 0);
  for (std::int64_t tick = 11; tick < 22; ++tick) EXPECT_EQ(player.at(tick).tool, -1);
  EXPECT_EQ(player.at(22).tool, 1);
  EXPECT_EQ(player.at(22).position, (Vec3{0.001, 0.002, 0.003}));
}

/// A scene of one block with a ball and a scalpel.
scenes::SceneSpec block_scene(const std::string& block, const std::string& gravity = "[0, 0, -9.81]") {
  const Result<scenes::SceneText> scene =
      scenes::read_scene(R"({"format": "ctpm-scene", "version": 1, "name": "block", "gravity_m_per_s2": )" + gravity +
                             R"(, "organs": [{"name": "block", "rig": {"block": )" + block +
                             R"(}, "material": {"preset": "liver"}}],
           "tools": [{"name": "ball", "kind": "ball", "radius_mm": 6}, {"name": "scalpel", "kind": "scalpel", "blade_length_mm": 40}]})",
                         "block.json");
  if (!scene) {
    ADD_FAILURE() << to_string(scene.errors().front());
    return {};
  }
  return scene->spec;
}

/// Tissue that pushes back with 100 N/m below `surface_z` [m].
Vec3 spring_force(const Inputs& inputs, double surface_z) {
  return {0, 0, std::max(0.0, 100 * (surface_z - inputs.position.z))};
}

const std::string kPressToForce = R"(, {"press": {"distance_mm": 20, "speed_mm_per_s": 10, "until_force_n": 0.5}},
                                       {"wait_s": 0.1}, {"release": {"distance_mm": 3, "speed_mm_per_s": 10}})";

TEST(ScriptPlayer, APressToAForceEndsWhereTheTissuePushesBackWithItAndTheNextStepsGoOnFromThere) {
  scenes::ScriptPlayer player(read_good(kTake + kPressToForce), tools_of_model(), kTick);
  const std::int64_t whole = player.tick_count();
  std::int64_t ended = -1;
  double lowest = 1;
  for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) {
    const Inputs before = player.at(tick);
    lowest = std::min(lowest, before.position.z);
    const scenes::PressEnd end = player.feel(tick, spring_force(before, 0.045));
    EXPECT_EQ(player.at(tick), before) << "what was done stays done";
    if (end == scenes::PressEnd::none) continue;
    EXPECT_EQ(end, scenes::PressEnd::at_force);
    EXPECT_EQ(ended, -1) << "it ends once";
    ended = tick;
  }
  // 0.5 N at 100 N/m are 5 mm below the surface; one tick goes 10 um.
  EXPECT_NEAR(lowest, 0.040, 1.1e-5);
  EXPECT_LE(lowest, 0.040);
  ASSERT_GT(ended, 0);
  for (std::int64_t tick = ended; tick < ended + 100; ++tick) EXPECT_EQ(player.at(tick).position.z, lowest);
  EXPECT_LT(player.tick_count(), whole);
  EXPECT_NEAR(player.at(player.tick_count()).position.z, lowest + 0.003, 1e-12);
}

TEST(ScriptPlayer, APressToAForceThatNeverComesGivesUpAtItsDepth) {
  scenes::ScriptPlayer player(read_good(kTake + kPressToForce), tools_of_model(), kTick);
  const std::int64_t whole = player.tick_count();
  int gave_up = 0;
  for (std::int64_t tick = 0; tick < player.tick_count(); ++tick)
    gave_up +=
        player.feel(tick, {0.6, 0.6, 0.49}) == scenes::PressEnd::at_depth;  // only what is against the way counts
  EXPECT_EQ(gave_up, 1);
  EXPECT_EQ(player.tick_count(), whole);
  EXPECT_NEAR(player.at(whole).position.z, 0.05 - 0.02 + 0.003, 1e-12);
}

TEST(ReadScript, AForceToPressToMustBeAPositiveNumber) {
  EXPECT_EQ(errors_of(script_of(kTake + ",\n" +
                                R"({"press": {"until_force_n": 0, "distance_mm": 5, "speed_mm_per_s": 10}})")),
            "s.json:3:29: error: /steps/1/press/until_force_n: got 0, must be in (0, 1000] N\n");
  EXPECT_NE(errors_of(script_of(kTake + R"(, {"press": {"until_force_n": 1, "speed_mm_per_s": 10}})"))
                .find("the key \"distance_mm\" is missing"),
            std::string::npos);
}

TEST(ScriptPlayer, ASmoothCutPassesItsPointsWithoutARestOrACorner) {
  const std::string path = R"("path_mm": [[10, 0, 50], [10, 10, 50], [12, 11, 50], [40, 0, 45]], "speed_mm_per_s": 20)";
  const scenes::Script script = read_good(kTake + R"(, {"cut": {)" + path + R"(, "smooth": true}})");
  const scenes::ScriptPlayer player(script, tools_of_model(), kTick);
  const std::vector<Vec3> way = way_in_hand(player);
  for (const Vec3& point : script.steps.at(1).cut->path) {
    double nearest = 1;
    for (const Vec3& p : way) nearest = std::min(nearest, norm(p - point));
    EXPECT_LT(nearest, 10.1e-6) << "half a tick's way";
  }
  EXPECT_EQ(way.back(), (Vec3{0.04, 0, 0.045}));
  const std::size_t first = way.size() / 5 + 1, last = way.size() - first - 1;
  for (std::size_t i = first; i < last; ++i) {
    const Vec3 before = way[i] - way[i - 1], after = way[i + 1] - way[i];
    EXPECT_NEAR(norm(after) / kTick, 20e-3, 0.2e-3) << "even speed, tick " << i;
    EXPECT_GT(dot(before, after), 0.97 * norm(before) * norm(after)) << "no corner, tick " << i;
  }
  // Without it there is a corner of a right angle, and a rest.
  const std::vector<Vec3> straight =
      way_in_hand(scenes::ScriptPlayer(read_good(kTake + R"(, {"cut": {)" + path + "}}"), tools_of_model(), kTick));
  double slowest = 1;
  for (std::size_t i = straight.size() / 5; i < straight.size() * 4 / 5; ++i)
    slowest = std::min(slowest, norm(straight[i] - straight[i - 1]) / kTick);
  EXPECT_LT(slowest, 1e-3);
}

TEST(ScriptPlayer, ASmoothCutOfPointsThatCoincideOrOfOneIsAStraightWay) {
  for (const std::string path : {"[[0, 0, 40]]", "[[0, 0, 50], [0, 0, 50], [0, 0, 40], [0, 0, 40]]",
                                 "[[1e-300, 0, 50], [0, 0, 50], [0, 0, 40]]"}) {
    const scenes::ScriptPlayer player(
        read_good(kTake + R"(, {"cut": {"smooth": true, "speed_mm_per_s": 20, "path_mm": )" + path + "}}"),
        tools_of_model(), kTick);
    for (const Vec3& p : way_in_hand(player)) {
      ASSERT_TRUE(is_finite(p)) << path;
      EXPECT_NEAR(p.x, 0, 1e-12);
    }
    EXPECT_EQ(player.at(player.tick_count()).position, (Vec3{0, 0, 0.04}));
  }
}

const std::string kTakeScalpel = R"({"take": {"tool": "scalpel", "at_mm": [20, 0, 50], "facing": [0, 1, 0]}})";

/// Around once, from where the scalpel is taken.
const std::string kRing =
    R"("path_mm": [[14, 14, 50], [0, 20, 50], [-14, 14, 50], [-20, 0, 50], [-14, -14, 50], [0, -20, 50], [14, -14, 50],
                [20, 0, 50]], "smooth": true, "speed_mm_per_s": 30)";

TEST(ScriptPlayer, ABladeThatTurnsLooksAlongItsWay) {
  const scenes::ScriptPlayer player(read_good(kTakeScalpel + R"(, {"cut": {"turns": true, )" + kRing + "}}"),
                                    tools_of_model(), kTick);
  Inputs before = player.at(1);
  for (std::int64_t tick = 2; tick < player.tick_count(); ++tick) {
    const Inputs now = player.at(tick);
    const Vec3 facing = rotate(now.world_from_tool, {1, 0, 0}), way = now.position - before.position;
    // It begins along y, where the curve through so few points begins 22 degrees off.
    EXPECT_GT(dot(facing, way), std::cos(0.5) * norm(way)) << "tick " << tick;
    EXPECT_NEAR(norm(rotate(now.world_from_tool, {0, 0, 1}) - Vec3{0, 0, 1}), 0, 1e-12) << "it stays upright";
    EXPECT_GT(dot(facing, rotate(before.world_from_tool, {1, 0, 0})), std::cos(0.01)) << "no jump, tick " << tick;
    before = now;
  }
  EXPECT_LT(dot(rotate(player.at(player.tick_count() / 2).world_from_tool, {1, 0, 0}), Vec3{0, 1, 0}), -0.9)
      << "half of the way around";
}

TEST(ScriptPlayer, WhatFollowsACutThatTurnedGoesOnAsTheBladeIsThen) {
  const scenes::ScriptPlayer player(read_good(kTakeScalpel +
                                              R"(, {"cut": {"turns": true, "smooth": true, "speed_mm_per_s": 30,
                     "path_mm": [[20, 10, 50], [10, 20, 50], [0, 20, 50]]}}, {"wait_s": 0.1},
                     {"cut": {"speed_mm_per_s": 30, "path_mm": [[0, 20, 40]]}})"),
                                    tools_of_model(), kTick);
  const Quat last = player.at(player.tick_count()).world_from_tool;
  EXPECT_LT(norm(rotate(last, {1, 0, 0}) - Vec3{-1, 0, 0}), 0.2);
  bool has_come = false;
  for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) {
    const Inputs now = player.at(tick);
    has_come = has_come || now.position == Vec3{0, 0.02, 0.05};
    if (has_come) {
      EXPECT_EQ(now.world_from_tool, last) << tick;
    }
  }
  EXPECT_TRUE(has_come);
}

TEST(ScriptPlayer, AWayAlongTheBladesOwnAxisTurnsNothing) {
  const scenes::ScriptPlayer player(
      read_good(kTakeScalpel +
                R"(, {"cut": {"turns": true, "smooth": true, "speed_mm_per_s": 30, "path_mm": [[20, 0, 30]]}})"),
      tools_of_model(), kTick);
  EXPECT_EQ(player.at(player.tick_count()).world_from_tool, player.at(0).world_from_tool);
}

TEST(ReadScript, ABladeTurnsAlongASmoothCutOnly) {
  EXPECT_EQ(
      errors_of(script_of(kTake + ",\n" + R"({"cut": {"turns": true, "path_mm": [[0, 0, 1]], "speed_mm_per_s": 5}})")),
      "s.json:3:19: error: /steps/1/cut/turns: a blade turns along a smooth cut only (write \"smooth\": true "
      "beside it)\n");
}

TEST(DefaultScript, OfAnyBlockIsReadWithTheScenesTools) {
  for (const std::string block : {"[9, 9, 7]", "[3, 3, 1]", "[1, 1, 5]", "[2, 1, 1]"})
    for (const std::string gravity : {"[0, 0, -9.81]", "[0, 0, 0]", "[5, 5, 5]"}) {
      const scenes::SceneSpec scene = block_scene(block, gravity);
      const std::vector<FilledOrgan> organs{scenes::fill_rig(scene.organs.at(0))};
      const scenes::Script script = scenes::default_script(scene, organs);
      const Result<scenes::Script> again = scenes::read_script(scenes::write_script(script), "default.json", kTools);
      ASSERT_TRUE(again) << block << " " << to_string(again.errors().front());
      EXPECT_TRUE(*again == script);
      EXPECT_GT(scenes::ScriptPlayer(script, tools_of_model(), kTick).tick_count(), 1000);
    }
}

TEST(DefaultScript, PressesIntoTheTopOfABlockAndCutsIt) {
  const scenes::SceneSpec scene = block_scene("[9, 9, 7]");
  const std::vector<FilledOrgan> organs{scenes::fill_rig(scene.organs.at(0))};
  const scenes::ScriptPlayer player(scenes::default_script(scene, organs), tools_of_model(), kTick);
  constexpr double kTop = (6 + 0.5) * 12e-3;  // [m]
  double lowest[2] = {1, 1};
  for (std::int64_t tick = 0; tick < player.tick_count(); ++tick) {
    const Inputs inputs = player.at(tick);
    if (inputs.tool < 0) continue;
    ASSERT_LT(std::max(std::abs(inputs.position.x), std::abs(inputs.position.y)), 0.05);
    lowest[inputs.tool] = std::min(lowest[inputs.tool], inputs.position.z);
  }
  // Both into the tissue, and neither through it.
  EXPECT_LT(lowest[0] - 0.006, kTop - 0.005);
  EXPECT_LT(lowest[1], kTop - 0.015);
  for (const double z : lowest) EXPECT_GT(z, kTop / 2);
}

TEST(DefaultScript, StaysAboveTheDepthThatTheSceneCallsDamage) {
  scenes::SceneSpec scene = block_scene("[9, 9, 7]");
  const std::vector<FilledOrgan> organs{scenes::fill_rig(scene.organs.at(0))};
  const auto deepest = [&] {
    const scenes::ScriptPlayer player(scenes::default_script(scene, organs), tools_of_model(), kTick);
    double lowest = 1;
    for (std::int64_t tick = 0; tick < player.tick_count(); ++tick)
      if (const Inputs inputs = player.at(tick); inputs.tool == 0) lowest = std::min(lowest, inputs.position.z - 0.006);
    return (6 + 0.5) * 12e-3 - lowest;  // below the top [m]
  };
  scene.organs[0].damage_depth = 0;
  EXPECT_GT(deepest(), 0.012);
  for (const double limit : {0.012, 0.006}) {
    scene.organs[0].damage_depth = limit;
    EXPECT_NEAR(deepest(), 0.8 * limit, 0.05 * limit);
  }
}

TEST(ScriptPlayer, FacingTurnsABladeAboutItsOwnAxisAlone) {
  for (const Vec3 way : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}, Vec3{0.6, 0.8, 0}}) {
    scenes::Script script;
    script.steps.emplace_back().take = scenes::ScriptStep::Take{"scalpel", {}, {0.3, 0.1, -1}, way};
    Tool scalpel;
    scalpel.name = "scalpel", scalpel.kind = ToolKind::scalpel;
    const Quat q = scenes::ScriptPlayer(script, std::span(&scalpel, 1), 1e-3).at(0).world_from_tool;
    const Vec3 pointing = Vec3{0.3, 0.1, -1} / norm(Vec3{0.3, 0.1, -1});
    EXPECT_NEAR(norm(rotate(q, {0, 0, -1}) - pointing), 0, 1e-14);
    // What of the way is across the tool's axis is where +x looks.
    const Vec3 across = way - dot(way, pointing) * pointing;
    EXPECT_NEAR(norm(rotate(q, {1, 0, 0}) - across / norm(across)), 0, 1e-14);
  }
}

TEST(DefaultScript, OfASceneWithoutToolsWaits) {
  scenes::SceneSpec scene = block_scene("[3, 3, 3]");
  scene.tools.clear();
  const std::vector<FilledOrgan> organs{scenes::fill_rig(scene.organs.at(0))};
  const scenes::Script script = scenes::default_script(scene, organs);
  EXPECT_TRUE(scenes::read_script(scenes::write_script(script), "default.json", {}));
}

}  // namespace
}  // namespace ctpm
