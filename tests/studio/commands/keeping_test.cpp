// No command replaces a file that it did not make unless it is told to, and what fails while recording is told at once.

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/studio/commands/running_program.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::RunningProgram;
using testing::slurp;
using testing::TemporaryFolder;

const std::string kScenes = std::string(CTPM_SOURCE_DIR) + "/scenes/";

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class Keeping : public ::testing::Test {
 protected:
  Keeping() {
    std::ofstream(folder_.path() / "block.json") << R"({"format": "ctpm-scene", "version": 1, "name": "block",
      "settle_s": 0, "organs": [{"name": "block", "rig": {"block": [3, 3, 2]}, "material": {"preset": "liver"},
      "anchors": [{"lowest_mm": 1}]}], "tools": [{"name": "ball", "kind": "ball", "radius_mm": 8}]})";
    std::ofstream(folder_.path() / "wait.json") << R"({"format": "ctpm-script", "version": 1, "steps": [
      {"take": {"tool": "ball", "at_mm": [0, 0, 40]}}, {"wait_s": 60}]})";
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void mine(const std::string& name) { std::ofstream(path(name)) << "mine"; }
  bool is_mine(const std::string& name) const { return slurp(path(name)) == "mine"; }
  ProgramOutcome ctpm(const std::vector<std::string>& arguments) { return run_ctpm(arguments, folder_.path()); }
  /// A second of a session at "a.ctpm".
  void record_a() {
    ASSERT_EQ(
        ctpm({"record", "block.json", "--script", "wait.json", "--duration-s", "0.3", "--fast", "-o", "a.ctpm"}).code,
        0);
  }
  /// Expects that the command refuses because of each of the user's files, and keeps them all.
  void expect_kept(const std::vector<std::string>& arguments, const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      mine(file);
      const ProgramOutcome outcome = ctpm(arguments);
      EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
      EXPECT_TRUE(holds(outcome.err, file + ": error: exists already")) << outcome.err;
      EXPECT_TRUE(is_mine(file)) << file;
      fs::remove(path(file));
    }
  }

  TemporaryFolder folder_;
};

TEST_F(Keeping, ImportsPreviewsAndTablesAskBeforeTheyReplaceAFile) {
  const std::vector<std::string> import{
      "import", kScenes + "organs/skin.obj", "--organ", "skin", "--unit", "mm", "-o", "s.json", "--report", "r.json"};
  expect_kept(import, {"s.json", "s.obj", "s.script.json", "r.json"});
  const std::vector<std::string> preview{"preview", "block.json", "-o", "p.png", "--size", "64x64"};
  expect_kept(preview, {"p.png"});
  record_a();
  const std::vector<std::string> replay{"replay", "a.ctpm", "--csv", "a.csv"};
  expect_kept(replay, {"a.csv"});
  for (std::vector<std::string> again : {preview, replay}) {
    EXPECT_EQ(ctpm(again).code, 0);
    EXPECT_EQ(ctpm(again).code, 2) << "even its own";
    again.push_back("--overwrite");
    EXPECT_EQ(ctpm(again).code, 0);
  }
}

TEST_F(Keeping, ExportsAskAndAFolderOfPicturesHasItsSidecarInside) {
  record_a();
  const auto exporting = [](const std::string& to) {
    return std::vector<std::string>{"export", "a.ctpm", "-o", to, "--size", "64x64", "--fps", "10"};
  };
  expect_kept(exporting("v.avi"), {"v.avi", "v.avi.json"});
  const std::string scene = slurp(path("block.json"));
  EXPECT_EQ(ctpm(exporting("block/")).code, 0);
  EXPECT_EQ(slurp(path("block.json")), scene) << "an author's scene of that name stays";
  EXPECT_TRUE(fs::exists(path("block/video.json")));
}

TEST_F(Keeping, AReportReplacesReportsAlone) {
  record_a();
  const std::vector<std::string> compare{"compare", "a.ctpm", "a.ctpm", "-o", "report"};
  fs::create_directory(path("report"));
  expect_kept(compare, {"report/report.html", "report/results.json"});
  EXPECT_EQ(ctpm(compare).code, 0);
  EXPECT_EQ(ctpm(compare).code, 0) << "its own it may replace";
}

TEST_F(Keeping, ASessionThatIsBeingRecordedIsNotReplaced) {
  RunningProgram program({"record", "block.json", "--script", "wait.json", "-o", "a.ctpm"}, folder_.path());
  for (int i = 0; i < 3000 && !fs::exists(path("a.ctpm-wal")); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const TemporaryFolder other;
  const ProgramOutcome outcome =
      run_ctpm({"record", path("block.json"), "-o", path("a.ctpm"), "--overwrite", "--fast", "--duration-s", "0.1"},
               other.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(holds(outcome.err, "is being recorded by another process")) << outcome.err;
  program.interrupt();
  EXPECT_EQ(program.outcome().code, 0);
  EXPECT_EQ(ctpm({"verify", "a.ctpm"}).code, 0);
}

TEST_F(Keeping, AFileThatIsRemovedWhileItIsRecordedIsToldAtOnceAndEndsTheSession) {
  RunningProgram program({"record", "block.json", "--script", "wait.json", "-o", "a.ctpm"}, folder_.path());
  // While it is being made there is no session yet whose recording could fail.
  const TemporaryFolder other;  // the output of programs lies in their folders
  EXPECT_TRUE(program.wait_until([&] { return run_ctpm({"info", path("a.ctpm")}, other.path()).code == 0; }));
  fs::remove(path("a.ctpm"));
  // The script would go on for a minute.
  EXPECT_NE(program.wait_for("recording fails now: the file was removed"), "");
  const ProgramOutcome outcome = program.outcome();
  EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
  EXPECT_FALSE(fs::exists(path("a.ctpm")));
}

TEST_F(Keeping, AFullDiskIsToldWhileTheSessionRuns) {
  // A session of 4 s takes some 95 KiB. No file may grow beyond 60 KiB; the signal of that is ignored, so that writing
  // fails as on a full disk.
  const ProgramOutcome outcome = testing::run({"bash", "-c",
                                               "trap '' XFSZ; ulimit -f 60; exec " + std::string(CTPM_PROGRAM) +
                                                   " record block.json --script wait.json --duration-s 4 -o a.ctpm"},
                                              folder_.path());
  EXPECT_EQ(outcome.code, 2) << outcome.out << outcome.err;
  EXPECT_TRUE(holds(outcome.err, "recording fails now: ")) << outcome.err;
  EXPECT_TRUE(holds(outcome.err, "ticks were not recorded")) << outcome.err;
  const ProgramOutcome left = ctpm({"verify", "a.ctpm"});
  EXPECT_EQ(left.code, 0) << left.out << left.err;
}

TEST_F(Keeping, UnfinishedFilesOfKilledStartsGoAndFilesOfUsersStay) {
  const std::string left = "a.ctpm.2147483646-0123abcd.part", other = "a.ctpm.notes.part";
  mine(left), mine(other);
  record_a();
  EXPECT_FALSE(fs::exists(path(left)));
  EXPECT_TRUE(is_mine(other));
}

}  // namespace
}  // namespace ctpm
