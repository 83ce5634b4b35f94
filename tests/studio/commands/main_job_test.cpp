// The whole main job, from outside, as a user runs it: mesh, scene, session, verified replay, video.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::run;
using testing::run_ctpm;
using testing::TemporaryFolder;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Imports a mesh, records it for a moment, verifies and exports it; every stage must be good.
void do_main_job(const TemporaryFolder& folder, const std::string& mesh,
                 const std::vector<std::string>& import_options) {
  std::vector<std::string> import{"import", mesh, "-o", "organ.json", "--report", "import.json"};
  import.insert(import.end(), import_options.begin(), import_options.end());
  const auto imported = run_ctpm(import, folder.path());
  ASSERT_EQ(imported.code, 0) << imported.err;
  EXPECT_TRUE(holds(imported.out, "next: ctpm record organ.json")) << imported.out;
  EXPECT_EQ(folder.list(), "import.json organ.json organ.obj organ.script.json");

  const auto checked = run_ctpm({"check", "organ.json"}, folder.path());
  EXPECT_EQ(checked.code, 0) << checked.err;
  const auto planned = run_ctpm({"plan", "organ.json"}, folder.path());
  EXPECT_NE(planned.out.find("or below 0.001 mm/s (velocity_floor_mm_per_s) or, after an iteration, 0.002 mm/s "
                             "(velocity_enough_mm_per_s), whichever is first"),
            std::string::npos)
      << planned.out;
  EXPECT_EQ(planned.code, 0) << planned.err;
  EXPECT_TRUE(holds(planned.out, "left out:")) << planned.out;
  const auto preview =
      run_ctpm({"preview", "organ.json", "-o", "organ.png", "--spheres", "--size", "640x360"}, folder.path());
  EXPECT_EQ(preview.code, 0) << preview.err;
  EXPECT_GT(fs::file_size(folder.path() / "organ.png"), 10000u);

  const auto recorded = run_ctpm(
      {"record", "organ.json", "--script", "organ.script.json", "-o", "session.ctpm", "--fast"}, folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  EXPECT_FALSE(holds(recorded.out, " 0 elements severed")) << recorded.out;
  const auto verified = run_ctpm({"verify", "session.ctpm"}, folder.path());
  EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
  EXPECT_TRUE(holds(verified.out, "same")) << verified.out;
  const auto info = run_ctpm({"info", "session.ctpm"}, folder.path());
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_TRUE(holds(info.out, "cut")) << info.out;
  const auto replayed =
      run_ctpm({"replay", "session.ctpm", "--from-s", "0.5", "--to-s", "0.6", "--csv", "session.csv", "--times", "3"},
               folder.path());
  EXPECT_EQ(replayed.code, 0) << replayed.err;
  EXPECT_TRUE(holds(replayed.out, "least time of each tick over 3 replays: p50 ")) << replayed.out;
  EXPECT_TRUE(holds(replayed.out, " of 100 above 1.000 ms")) << replayed.out;
  const std::string csv = testing::slurp(folder.path() / "session.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 101);  // a header and 100 ticks

  const auto exported =
      run_ctpm({"export", "session.ctpm", "-o", "session.mp4", "--size", "320x180", "--from-s", "0.5", "--to-s", "1.5"},
               folder.path());
  ASSERT_EQ(exported.code, 0) << exported.err;
  EXPECT_TRUE(holds(exported.out, "30 frames, 320x180, 30 frames/s, H.264")) << exported.out;
  EXPECT_TRUE(fs::exists(folder.path() / "session.mp4.json"));
  const auto probed =
      run({"ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0", "-show_entries",
           "stream=codec_name,width,height,r_frame_rate,nb_read_frames", "-of", "csv=p=0", "session.mp4"},
          folder.path());
  EXPECT_EQ(probed.out, "h264,320,180,30/1,30\n") << probed.err;
}

TEST(MainJob, GoesFromTheShippedKidneyToAVideo) {
  const TemporaryFolder folder;
  do_main_job(folder, std::string(CTPM_SOURCE_DIR) + "/scenes/organs/kidney.obj", {"--radius-mm", "5"});
}

TEST(MainJob, SlowGoesFromAScannedLiverInCentimetresToAVideo) {
  const fs::path mesh = fs::path(CTPM_SOURCE_DIR) / "../shared/meshes/liver-smooth.obj";
  if (!fs::exists(mesh)) GTEST_SKIP() << mesh << " is not there";
  const TemporaryFolder folder;
  do_main_job(folder, fs::canonical(mesh).string(), {"--organ", "liver", "--radius-mm", "2"});
  EXPECT_TRUE(holds(testing::slurp(folder.path() / "import.json"), "\"unit\": \"cm\""));
}

TEST(MainJob, TheSameScriptRecordsTheSameSessionTwice) {
  const TemporaryFolder folder;
  const std::string scene = std::string(CTPM_SOURCE_DIR) + "/scenes/skin.json";
  std::string tables[2];
  for (int i = 0; i < 2; ++i) {
    const std::string session = std::to_string(i) + ".ctpm", table = std::to_string(i) + ".csv";
    ASSERT_EQ(run_ctpm({"record", scene, "-o", session, "--fast", "--duration-s", "1.2"}, folder.path()).code, 0);
    ASSERT_EQ(run_ctpm({"replay", session, "--csv", table}, folder.path()).code, 0);
    tables[i] = testing::slurp(folder.path() / table);
  }
  EXPECT_EQ(tables[0], tables[1]);
}

TEST(MainJob, AForceBeyondTheScenesLimitIsNotedInTheSession) {
  const TemporaryFolder folder;
  fs::copy(fs::path(CTPM_SOURCE_DIR) / "scenes/organs/skin.obj", folder.path() / "skin.obj");
  std::string scene = testing::slurp(fs::path(CTPM_SOURCE_DIR) / "scenes/skin.json");
  scene.replace(scene.find("organs/skin.obj\","), 17, "skin.obj\", \"damage_force_n\": 0.05,");
  std::ofstream(folder.path() / "skin.json") << scene;
  const auto recorded =
      run_ctpm({"record", "skin.json", "-o", "skin.ctpm", "--fast", "--duration-s", "1.2"}, folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const auto info = run_ctpm({"info", "skin.ctpm"}, folder.path());
  EXPECT_TRUE(holds(info.out, " N passes the damage limit of ")) << info.out;
}

}  // namespace
}  // namespace ctpm
