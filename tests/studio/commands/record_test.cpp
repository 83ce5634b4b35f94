// `ctpm record` from outside: its sources, and going on from a moment of another session.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using testing::run_ctpm;
using testing::slurp;
using testing::TemporaryFolder;

class Record : public ::testing::Test {
 protected:
  /// A block that takes no import and a moment to record; its uppermost spheres end at 16 mm.
  Record() {
    write("block.json", R"({"format": "ctpm-scene", "version": 1, "name": "block",
      "settle_s": 0, "organs": [{"name": "block", "rig": {"block": [3, 3, 2]}, "material": {"preset": "liver"},
      "anchors": [{"lowest_mm": 1}]}],
      "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8}]})");
    write("press.json", R"({"format": "ctpm-script", "version": 1, "steps": [
      {"take": {"tool": "ball", "at_mm": [0, 0, 25]}}, {"press": {"distance_mm": 5, "speed_mm_per_s": 10}},
      {"wait_s": 0.5}, {"release": {"distance_mm": 10, "speed_mm_per_s": 20}}]})");
  }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_.path() / name) << text; }
  std::string ctpm(const std::vector<std::string>& arguments, int code = 0) {
    const auto outcome = run_ctpm(arguments, folder_.path());
    EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
    return outcome.out + outcome.err;
  }
  static bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

  TemporaryFolder folder_;
};

/// Value of column `column` in the row of tick `tick` of a table.
std::string cell(const std::string& table, int tick, int column) {
  std::size_t at = 0;
  for (int line = 0; line <= tick; ++line) at = table.find('\n', at) + 1;
  for (int i = 0; i < column; ++i) at = table.find(',', at) + 1;
  return table.substr(at, table.find_first_of(",\n", at) - at);
}
constexpr int kForceZ = 13;

TEST_F(Record, AScriptThatMissesTheOrganIsTold) {
  const auto script = [](const std::string& tool, const std::string& at) {
    return R"({"format": "ctpm-script", "version": 1, "steps": [{"take": {"tool": ")" + tool + R"(", "at_mm": )" + at +
           R"(}}, {"press": {"distance_mm": 6, "speed_mm_per_s": 60}}]})";
  };
  std::string scene = slurp(folder_.path() / "block.json");
  scene.insert(scene.rfind(']'), R"(, {"name": "scalpel", "kind": "scalpel", "blade_length_mm": 20})");
  write("both.json", scene);
  const auto say = [&](const std::string& text) {
    write("script.json", text);
    const std::string checked = ctpm({"check", "both.json", "--script", "script.json"});
    return std::pair{checked,
                     ctpm({"record", "both.json", "--script", "script.json", "-o", "a.ctpm", "--fast", "--overwrite"})};
  };
  // 400 mm beside it; above it, where only the run tells; a blade above it; a press that meets it.
  const auto far = say(script("ball", "[400, 0, 25]"));
  EXPECT_TRUE(holds(far.first, "script.json: warning: no tool comes near any organ")) << far.first;
  EXPECT_TRUE(holds(far.first, "1 warning")) << far.first;
  EXPECT_TRUE(holds(far.second, "script.json: warning: never touches any tissue")) << far.second;
  const auto above = say(script("ball", "[0, 0, 40]"));
  EXPECT_FALSE(holds(above.first, "warning")) << above.first;
  EXPECT_TRUE(holds(above.second, "script.json: warning: never touches any tissue")) << above.second;
  const auto blade = say(script("scalpel", "[0, 0, 40]"));
  EXPECT_TRUE(holds(blade.second, "script.json: warning: never touches any tissue")) << blade.second;
  const auto good = say(script("ball", "[0, 0, 25]"));
  EXPECT_FALSE(holds(good.first + good.second, "warning")) << good.first << good.second;
  const auto idle = say(R"({"format": "ctpm-script", "version": 1, "steps": [{"wait_s": 0.1}]})");
  EXPECT_FALSE(holds(idle.first + idle.second, "warning")) << idle.first << idle.second;
}

TEST_F(Record, ATableThatReplayWroteIsAMotionThatGivesTheSameForces) {
  ctpm({"record", "block.json", "--script", "press.json", "-o", "a.ctpm", "--fast"});
  ctpm({"replay", "a.ctpm", "--csv", "a.csv"});
  const std::string said = ctpm({"record", "block.json", "--motion", "a.csv", "-o", "b.ctpm", "--fast"});
  EXPECT_TRUE(holds(said, "left out: tick, force_x_n")) << said;
  EXPECT_TRUE(holds(ctpm({"verify", "b.ctpm"}), "same"));
  EXPECT_TRUE(holds(ctpm({"info", "b.ctpm"}), "source     motion"));
  ctpm({"replay", "b.ctpm", "--csv", "b.csv"});
  const std::string a = slurp(folder_.path() / "a.csv"), b = slurp(folder_.path() / "b.csv");
  ASSERT_EQ(std::count(a.begin(), a.end(), '\n'), std::count(b.begin(), b.end(), '\n'));
  const double pressed = std::stod(cell(a, 900, kForceZ));
  EXPECT_GT(pressed, 0.1);
  // The table holds nine digits of each position.
  EXPECT_NEAR(std::stod(cell(b, 900, kForceZ)), pressed, 1e-5 * pressed);
}

TEST_F(Record, AMotionAtAnyRateIsSampledEveryTick) {
  write("slow.csv", "time_s,tool_x_mm,tool_y_mm,tool_z_mm\n100,0,0,40\n100.35,0,0,22\n100.4,0,0,22\n");
  ctpm({"record", "block.json", "--motion", "slow.csv", "-o", "a.ctpm", "--fast"});
  ctpm({"replay", "a.ctpm", "--csv", "a.csv"});
  const std::string table = slurp(folder_.path() / "a.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 401);
  constexpr int kToolZ = 5;
  EXPECT_NEAR(std::stod(cell(table, 175, kToolZ)), 31, 1e-6);
  EXPECT_NEAR(std::stod(cell(table, 380, kToolZ)), 22, 1e-6);
}

TEST_F(Record, APressToAForceStopsAtItAndOneThatCannotReachItSaysSo) {
  const auto script = [](const std::string& force) {
    return R"({"format": "ctpm-script", "version": 1, "steps": [{"take": {"tool": "ball", "at_mm": [0, 0, 28]}},
      {"press": {"distance_mm": 9, "speed_mm_per_s": 10, "until_force_n": )" +
           force + "}}, {\"wait_s\": 0.2}]}";
  };
  write("some.json", script("0.2")), write("much.json", script("500"));
  ctpm({"record", "block.json", "--script", "some.json", "-o", "some.ctpm", "--fast"});
  ctpm({"record", "block.json", "--script", "much.json", "-o", "much.ctpm", "--fast"});
  EXPECT_TRUE(holds(ctpm({"info", "some.ctpm"}), "press reached its force: "));
  EXPECT_TRUE(holds(ctpm({"info", "much.ctpm"}), "press gave up: "));
  EXPECT_TRUE(holds(ctpm({"verify", "some.ctpm"}), "same"));
  const std::string info = ctpm({"info", "some.ctpm", "--json"});
  const double most = std::stod(info.substr(info.find("\"max_force_n\":") + 14));
  EXPECT_GE(most, 0.2);
  EXPECT_LT(most, 0.22);
}

TEST_F(Record, ASessionGoesOnFromAMomentOfAnotherAndRemembersIt) {
  ctpm({"record", "block.json", "--script", "press.json", "-o", "a.ctpm", "--fast"});
  write("hold.csv", "time_s,tool_x_mm,tool_y_mm,tool_z_mm\n0,0,0,20\n0.3,0,0,20\n");
  ctpm({"record", "--continue", "a.ctpm", "--at", "0.7", "--motion", "hold.csv", "-o", "b.ctpm", "--fast"});
  EXPECT_TRUE(holds(ctpm({"verify", "b.ctpm"}), "same"));
  const std::string parent = ctpm({"info", "a.ctpm"}), child = ctpm({"info", "b.ctpm"});
  EXPECT_FALSE(holds(parent, "parent"));
  const std::string id = parent.substr(parent.find("session    ") + 11, 32);
  EXPECT_TRUE(holds(child, "parent     " + id + ", from tick 700 on")) << child;
  EXPECT_TRUE(holds(child, "source     motion")) << child;
  // The ball rests where the parent's rested, in tissue that had crept for as long: so the force goes on as well.
  ctpm({"replay", "a.ctpm", "--csv", "a.csv"});
  ctpm({"replay", "b.ctpm", "--csv", "b.csv"});
  const std::string a = slurp(folder_.path() / "a.csv"), b = slurp(folder_.path() / "b.csv");
  EXPECT_GT(std::stod(cell(a, 710, kForceZ)), 0.1);
  for (const int tick : {0, 10, 200}) EXPECT_EQ(cell(b, tick, kForceZ), cell(a, 700 + tick, kForceZ)) << tick;
  // And so on: a child has children.
  ctpm({"record", "--continue", "b.ctpm", "--at", "0.301", "--script", "press.json", "-o", "c.ctpm", "--fast"});
  EXPECT_TRUE(holds(ctpm({"verify", "c.ctpm"}), "same"));
}

TEST_F(Record, WhatDoesNotFitTogetherIsToldAtOnceAndNothingIsWritten) {
  const auto refused = [&](std::vector<std::string> arguments, const std::vector<std::string>& parts) {
    const std::string before = folder_.list();
    arguments.insert(arguments.begin(), "record");
    const std::string said = ctpm(arguments, 2);
    for (const std::string& part : parts) EXPECT_TRUE(holds(said, part)) << part << " is not in: " << said;
    EXPECT_EQ(folder_.list(), before);
  };
  refused({"-o", "x.ctpm"}, {"needs either a scene or --continue"});
  refused({"block.json", "--continue", "a.ctpm", "--script", "s", "--motion", "m", "-o", "no/x.ctpm"},
          {"needs either a scene or --continue", "--continue: error: needs --at",
           "takes one of --script, --motion, --igtl, --igtl-listen", "no/x.ctpm: error:"});
  refused({"--continue", "a.ctpm", "--at", "1", "-o", "x.ctpm"}, {"--continue: error: needs a source"});
  refused({"block.json", "--at", "1", "-o", "x.ctpm"}, {"--at: error:"});
  refused({"--continue", "nowhere.ctpm", "--at", "1", "--script", "press.json", "-o", "x.ctpm"},
          {"nowhere.ctpm: error:"});
  refused({"block.json", "--motion", "nowhere.csv", "-o", "x.ctpm"}, {"nowhere.csv: error: does not exist"});
  // Files that are missing are said with all that is wrong besides.
  refused({"none.json", "--script", "none-either.json", "--duration-s", "-1", "-o", "no/x.ctpm"},
          {"none.json: error: does not exist", "none-either.json: error: does not exist",
           "--duration-s: error:", "no/x.ctpm: error:"});
  refused({"--continue", "nowhere.ctpm", "--at", "1", "--motion", "nowhere.csv", "-o", "no/x.ctpm"},
          {"nowhere.ctpm: error: does not exist", "nowhere.csv: error: does not exist", "no/x.ctpm: error:"});
  write("bad.csv", "time_s,tool_x_mm,tool_y_mm,tool_z_mm\n0,0,0,nan\n");
  refused({"block.json", "--motion", "bad.csv", "-o", "x.ctpm"}, {"bad.csv:2:7: error: tool_z_mm: got 'nan'"});
  ctpm({"record", "block.json", "--script", "press.json", "-o", "a.ctpm", "--fast", "--duration-s", "0.1"});
  for (const std::string at : {"0.2", "-1", "nan"})
    refused({"--continue", "a.ctpm", "--at", at, "--script", "press.json", "-o", "x.ctpm"},
            {"--at: error: got", "must be in [0, 0.100] s: so long lasts a.ctpm"});
}

TEST_F(Record, OnlyASessionInRealTimeSaysThatNoTickWasLate) {
  EXPECT_TRUE(holds(ctpm({"record", "block.json", "--script", "press.json", "-o", "fast.ctpm", "--fast"}),
                    "ms, not in real time"));
  EXPECT_TRUE(holds(ctpm({"info", "fast.ctpm"}), "nothing known of late ones (--fast"));
  EXPECT_TRUE(holds(ctpm({"record", "block.json", "--script", "press.json", "-o", "real.ctpm", "--duration-s", "0.2"}),
                    " late"));
  EXPECT_TRUE(holds(ctpm({"info", "real.ctpm"}), " late"));
}

TEST_F(Record, AMotionThatTouchesNothingIsTold) {
  write("far.csv", "time_s,tool_x_mm,tool_y_mm,tool_z_mm\n0,5000,0,60\n0.1,5000,0,55\n");
  const auto done =
      testing::run_ctpm({"record", "block.json", "--motion", "far.csv", "-o", "far.ctpm", "--fast"}, folder_.path());
  EXPECT_EQ(done.code, 0);
  EXPECT_NE(done.err.find("far.csv: warning: never touches any tissue"), std::string::npos) << done.err;
  EXPECT_EQ(done.err.find("in the first tick"), std::string::npos) << done.err;
}

TEST_F(Record, AToolThatBeginsInTheTissueIsTold) {
  write("deep.csv", "time_s,tool_x_mm,tool_y_mm,tool_z_mm\n0,0,0,15\n0.1,0,0,16\n");
  const auto done =
      testing::run_ctpm({"record", "block.json", "--motion", "deep.csv", "-o", "deep.ctpm", "--fast"}, folder_.path());
  EXPECT_EQ(done.code, 0);
  EXPECT_NE(done.err.find("mm deep in tissue in the first tick"), std::string::npos) << done.err;
  const auto later = testing::run_ctpm(
      {"record", "--continue", "deep.ctpm", "--at", "0.05", "--motion", "deep.csv", "-o", "later.ctpm", "--fast"},
      folder_.path());
  EXPECT_EQ(later.err.find("in the first tick"), std::string::npos) << later.err;
}

TEST_F(Record, AScriptOrAMotionMayComeThroughAPipe) {
  write("motion.csv", "time_s,tool_x_mm,tool_y_mm,tool_z_mm\n0,0,0,60\n0.1,0,0,55\n");
  for (const char* source : {"--script <(cat press.json)", "--motion <(cat motion.csv)"}) {
    const testing::ProgramOutcome done = testing::run({"bash", "-c",
                                                       std::string(CTPM_PROGRAM) + " record block.json " + source +
                                                           " -o piped.ctpm --overwrite --fast --duration-s 0.1"},
                                                      folder_.path());
    EXPECT_EQ(done.code, 0) << source << ": " << done.err;
  }
}

/// "N ticks" of the line that begins with `what`; -1 if there is none.
std::int64_t ticks_in(const std::string& text, const std::string& what) {
  const std::size_t line = text.find("\n  " + what);
  if (line == std::string::npos) return -1;
  // Beside other programs, more times stand before it.
  const std::size_t end = text.find(" ticks", line);
  return std::stoll(text.substr(text.rfind(' ', end - 1) + 1));
}

TEST_F(Record, PlanMeasuresTheTicksOfTheSessionThatIsRecorded) {
  const std::string planned = ctpm({"plan", "block.json", "--script", "press.json"}),
                    recorded = ctpm({"record", "block.json", "--script", "press.json", "-o", "a.ctpm", "--fast"});
  EXPECT_GT(ticks_in(recorded, "in contact"), 500) << recorded;
  EXPECT_EQ(ticks_in(planned, "in contact"), ticks_in(recorded, "in contact")) << planned << recorded;
  EXPECT_EQ(ticks_in(planned, "in a cut"), -1) << planned;
  EXPECT_TRUE(holds(planned, "1 kHz at p99")) << planned;
  EXPECT_TRUE(holds(ctpm({"plan", "block.json", "--quick"}), "at rest, measured now")) << planned;
  EXPECT_TRUE(holds(ctpm({"plan", "block.json", "--json"}), "\"deed\": \"in contact\""));
}

/// Two blocks 120 mm apart; their spheres are 12 mm from each other.
std::string two_blocks(const std::string& solver) {
  std::string cells;
  for (int i = 0; i < 18; ++i)
    cells += (i > 0 ? ", [" : "[") + std::to_string(10 + i % 3) + ", " + std::to_string(i / 3 % 3) + ", " +
             std::to_string(i / 9) + "]";
  return R"({"format": "ctpm-scene", "version": 1, "name": "two", "settle_s": 0,
    "organs": [{"name": "block", "rig": {"block": [3, 3, 2]}, "material": {"preset": "liver"},
                "anchors": [{"lowest_mm": 1}]},
               {"name": "other", "rig": {"cells": [)" +
         cells + R"(]}, "material": {"preset": "liver"}, "anchors": [{"lowest_mm": 1}]}],
    "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8}])" +
         solver + "}";
}

TEST_F(Record, AnOrganThatStandsStillSleepsAndItsSessionReplays) {
  write("two.json", two_blocks(R"(, "solver": {"sleep_below_mm_per_s": 0.01})"));
  write("awake.json", two_blocks(""));
  EXPECT_TRUE(holds(ctpm({"plan", "two.json", "--quick"}),
                    "2 parts, of 18 and 18 spheres, each while nothing in it is faster than 0.01 mm/s"));
  EXPECT_TRUE(holds(ctpm({"plan", "awake.json", "--quick"}), "the scene does not ask for it"));
  for (const std::string scene : {"two", "awake"})
    ctpm({"record", scene + ".json", "--script", "press.json", "-o", scene + ".ctpm", "--fast"});
  EXPECT_TRUE(holds(ctpm({"verify", "two.ctpm"}), "same"));
  // From a moment at which the second block sleeps.
  ctpm({"replay", "two.ctpm", "--from-s", "1.2", "--to-s", "1.3", "--csv", "late.csv"});
  ctpm({"replay", "awake.ctpm", "--from-s", "1.2", "--to-s", "1.3", "--csv", "awake.csv"});
  const std::string late = slurp(folder_.path() / "late.csv"), awake = slurp(folder_.path() / "awake.csv");
  EXPECT_GT(std::abs(std::stod(cell(awake, 50, kForceZ))), 0.01);
  EXPECT_NEAR(std::stod(cell(late, 50, kForceZ)), std::stod(cell(awake, 50, kForceZ)), 1e-3);
  // Its going on is the same, whether the way there is replayed or not.
  ctpm({"record", "--continue", "two.ctpm", "--at", "1", "--script", "press.json", "-o", "on.ctpm", "--fast",
        "--duration-s", "0.5"});
  EXPECT_TRUE(holds(ctpm({"verify", "on.ctpm"}), "same"));
}

}  // namespace
}  // namespace ctpm
