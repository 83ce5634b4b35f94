// A long export from outside.

#include <gtest/gtest.h>

#include <fstream>

#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using testing::run_ctpm;
using testing::TemporaryFolder;

TEST(ExportSlow, TenMinutesTakeNoMoreMemoryThanTwentySeconds) {
  constexpr double kNoise = 12;  // [MiB] of the allocator, and of the reader's chunks
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "long.json") << R"({"format": "ctpm-script", "version": 1, "steps": [
             {"take": {"tool": "ball", "at_mm": [10, 10, 43]}},
             {"press": {"distance_mm": 11, "speed_mm_per_s": 20}},
             {"wait_s": 600}]})";
  const auto recorded = run_ctpm({"record", std::string(CTPM_SOURCE_DIR) + "/scenes/skin.json", "--script", "long.json",
                                  "-o", "long.ctpm", "--fast"},
                                 folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const auto memory_to = [&](const char* end) {
    const auto exported = run_ctpm(
        {"export", "long.ctpm", "-o", std::string(end) + ".mp4", "--size", "320x180", "--to-s", end}, folder.path());
    EXPECT_EQ(exported.code, 0) << exported.err;
    return exported.memory_mib;
  };
  const double seconds_20 = memory_to("20"), minutes_10 = memory_to("600");
  RecordProperty("mib_of_20_s", std::to_string(seconds_20));
  RecordProperty("mib_of_600_s", std::to_string(minutes_10));
  std::printf("most memory: %.1f MiB over 20 s, %.1f MiB over 600 s\n", seconds_20, minutes_10);
  EXPECT_LT(minutes_10, seconds_20 + kNoise);
}

}  // namespace
}  // namespace ctpm
