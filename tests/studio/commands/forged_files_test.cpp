// Forged sessions through the program: whatever a file says, each command ends with an exit code of its own, in bounded
// memory and time, writes nothing that steers a terminal, and leaves no half video behind.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "tests/recordings/forgeries.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::ProgramOutcome;
using testing::run_ctpm;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

bool is_plain(const std::string& text) {
  return std::ranges::none_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n'; });
}

class ForgedProgram : public ::testing::Test {
 protected:
  static constexpr double kMostSeconds = 10;   // of computing time
  static constexpr double kMostMemory = 1000;  // [MiB]

  /// A session of 1.2 s in which a ball presses and a blade cuts, with keyframes and events. `more`: of the scene;
  /// `first_steps`: of the script, each with a comma.
  void record(const std::string& name, const std::string& more, const std::string& first_steps = "") const {
    std::ofstream(folder_.path() / (name + ".json"))
        << R"({"format": "ctpm-scene", "version": 1, "name": "block", "settle_s": 0, )" << more << R"(
           "organs": [{"name": "block", "rig": {"block": [4, 3, 3]}, "material": {"preset": "liver"},
           "anchors": [{"lowest_mm": 1}]}], "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8},
           {"name": "scalpel", "kind": "scalpel", "blade_length_mm": 30},
           {"name": "holder", "kind": "ball", "radius_mm": 6}]})";
    std::ofstream(folder_.path() / "script.json")
        << R"({"format": "ctpm-script", "version": 1, "steps": [)" << first_steps << R"(
        {"take": {"tool": "ball", "at_mm": [0, 0, 50]}}, {"press": {"distance_mm": 30, "speed_mm_per_s": 120}},
        {"put_away": true}, {"take": {"tool": "scalpel", "at_mm": [-40, 0.2, 20]}},
        {"cut": {"path_mm": [[40, 0.2, 20]], "speed_mm_per_s": 200}}, {"put_away": true}, {"wait_s": 0.4}]})";
    const ProgramOutcome recorded =
        run_ctpm({"record", name + ".json", "--script", "script.json", "-o", name + ".ctpm", "--fast"}, folder_.path());
    ASSERT_EQ(recorded.code, 0) << recorded.err;
    EXPECT_FALSE(holds(recorded.out, " 0 elements severed")) << recorded.out;
  }

  /// Runs a command on the forged session. What it may not do whatever the file says; the exit code.
  int run(const std::vector<std::string>& command, const std::string& what) {
    const ProgramOutcome outcome = run_ctpm(command, folder_.path());
    EXPECT_TRUE(outcome.code >= 0 && outcome.code <= 2) << what << " ended " << command[0] << ": " << outcome.err;
    EXPECT_EQ(outcome.code == 2, holds(outcome.err, "error: ")) << what << ", " << command[0] << ": " << outcome.err;
    EXPECT_TRUE(is_plain(outcome.out) && is_plain(outcome.err)) << what << ", " << command[0];
    EXPECT_LT(outcome.cpu_s, kMostSeconds) << what << ", " << command[0];
    EXPECT_LT(outcome.memory_mib, kMostMemory) << what << ", " << command[0];
    longest_ = std::max(longest_, outcome.cpu_s), largest_ = std::max(largest_, outcome.memory_mib);
    return outcome.code;
  }

  void forge(int count, unsigned first_seed) {
    ASSERT_NO_FATAL_FAILURE(record("plain", ""));
    ASSERT_NO_FATAL_FAILURE(record("meets", R"("organs_meet": true,)"));
    ASSERT_NO_FATAL_FAILURE(record("two-hands", R"("hands": 2,)",
                                   R"({"take": {"tool": "holder", "at_mm": [20, 8, 40]}, "hand": 2},
                                      {"press": {"distance_mm": 20, "speed_mm_per_s": 200}, "hand": 2},)"));
    const char* const names[] = {"meets.ctpm", "two-hands.ctpm", "plain.ctpm", "plain.ctpm"};
    int refused = 0, different = 0, same = 0, exported = 0;
    for (int i = 0; i < count; ++i) {
      const fs::path forged = folder_.path() / "forged.ctpm";
      fs::copy_file(folder_.path() / names[i % 4], forged, fs::copy_options::overwrite_existing);
      std::string what;
      const bool is_false = testing::forge_session(forged.string(), first_seed + unsigned(i), what);
      const int verified = run({"verify", "forged.ctpm"}, what);
      EXPECT_FALSE(is_false && verified == 0) << what << " is said to be the same";
      ++(verified == 0 ? same : verified == 1 ? different : refused);
      run({"info", "forged.ctpm"}, what);
      const int filmed = run(
          {"export", "forged.ctpm", "-o", "f.avi", "--size", "64x64", "--fps", "5", "--from-s", "0.5", "--to-s", "1.1"},
          what);
      EXPECT_EQ(filmed != 2, fs::exists(folder_.path() / "f.avi")) << what;
      EXPECT_EQ(filmed != 2, fs::exists(folder_.path() / "f.avi.json")) << what;
      if (filmed != 2) ++exported;
      fs::remove(folder_.path() / "f.avi"), fs::remove(folder_.path() / "f.avi.json");
    }
    std::printf(
        "%d forged files through verify, info and export: %d refused, %d different, %d same; %d exported; at most "
        "%.2f s and %.0f MiB each\n",
        count, refused, different, same, exported, longest_, largest_);
    EXPECT_GT(refused, 0);
    EXPECT_GT(same, 0);
    EXPECT_GT(exported, 0);
  }

  const testing::TemporaryFolder folder_;
  double longest_ = 0, largest_ = 0;  ///< [s], [MiB]
};

TEST_F(ForgedProgram, TwentyEndEachCommandInBoundsAndDeceiveNone) { forge(20, 5000); }

class ForgedProgramSlow : public ForgedProgram {};
TEST_F(ForgedProgramSlow, TwoHundredEndEachCommandInBoundsAndDeceiveNone) { forge(200, 6000); }

}  // namespace
}  // namespace ctpm
