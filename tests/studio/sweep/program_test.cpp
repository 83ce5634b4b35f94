// `ctpm sweep` as a researcher uses it: planned, run, killed, gone on with, collected.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "recordings/session_reader.h"
#include "tests/studio/commands/running_program.h"
#include "tests/studio/sweep/sweep_files.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::ProgramOutcome;
using testing::slurp;

const char* const kStiffness = R"("vary": [
  {"key": "/organs/0/material/stiffness_scale", "values": [0.5, 1, 2]},
  {"of": "script", "key": "/steps/1/press/distance_mm", "from": 2, "to": 4, "steps": 2}])";

class SweepProgram : public ::testing::Test {
 protected:
  ProgramOutcome run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "sweep");
    return testing::run_ctpm(arguments, folder());
  }
  const fs::path& folder() const { return temporary_.path(); }
  fs::path out() const { return folder() / "out"; }
  /// Beside a program that runs in the folder.
  std::string status() const {
    fs::create_directories(folder() / "aside");
    return testing::run_ctpm({"sweep", "status", "../out"}, folder() / "aside").out;
  }
  std::size_t count_finished() const {
    std::size_t count = 0;
    if (fs::exists(out() / "tasks"))
      for (const auto& entry : fs::directory_iterator(out() / "tasks"))
        count += entry.path().filename().string().front() != '.';
    return count;
  }
  /// Children of a process, from /proc.
  static std::vector<pid_t> children_of(pid_t parent) {
    std::ifstream file("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children");
    std::vector<pid_t> children;
    for (pid_t child = 0; file >> child;) children.push_back(child);
    return children;
  }

 private:
  testing::TemporaryFolder temporary_;
};

TEST_F(SweepProgram, RecordsEverySessionAsRecordWould) {
  testing::write_rig(folder());
  testing::write_sweep(folder(), kStiffness);
  const ProgramOutcome planned = run({"plan", "sweep.json", "-o", "out"});
  ASSERT_EQ(planned.code, 0) << planned.err;
  EXPECT_EQ(planned.out, "out: 6 sessions planned\n");
  EXPECT_EQ(status(), "../out: 0 of 6 done, 6 waiting\n");
  const ProgramOutcome refused = run({"collect", "out"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("is incomplete: 0 of 6 done, 6 waiting"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("--incomplete"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(out() / "results.csv"));
  const ProgramOutcome ran = run({"run", "out", "--jobs", "2"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.out.find("out: 6 of 6 done\n"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("of which the sweep itself"), std::string::npos) << ran.out;
  ASSERT_EQ(run({"collect", "out"}).code, 0);

  const std::vector<std::string> rows = testing::lines_of(slurp(out() / "results.csv"));
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_EQ(rows[0].find("task,id,state,stiffness_scale,distance_mm,duration_s,max_force_n,"), 0u) << rows[0];
  const std::vector<std::string> fourth = testing::cells_of(rows[4]);
  EXPECT_EQ(fourth[0] + fourth[2] + fourth[3] + " " + fourth[4], "4done1 4");
  // The fourth session is the scene and the script as they stand, but for a key that says what holds anyway.
  ASSERT_EQ(
      testing::run_ctpm({"record", "rig.json", "--script", "press.json", "-o", "a.ctpm", "--fast"}, folder()).code, 0);
  auto alone = recordings::SessionReader::open((folder() / "a.ctpm").string());
  auto swept = recordings::SessionReader::open((out() / "tasks" / fourth[1] / "session.ctpm").string());
  ASSERT_TRUE(alone && swept);
  ASSERT_EQ(alone->tick_count(), swept->tick_count());
  const auto a = alone->ticks(0, alone->tick_count()), b = swept->ticks(0, swept->tick_count());
  ASSERT_TRUE(a && b);
  for (std::size_t i = 0; i < a->size(); ++i) ASSERT_EQ((*a)[i].state_hash, (*b)[i].state_hash) << i;
  EXPECT_DOUBLE_EQ(std::stod(fourth[6]), alone->statistics()->max_force);
  // Another stiffness, another session, which replays from its own file.
  const std::vector<std::string> last = testing::cells_of(rows[6]);
  EXPECT_NEAR(std::stod(last[6]) / std::stod(fourth[6]), 2, 0.1);
  EXPECT_EQ(testing::run_ctpm({"verify", "out/tasks/" + last[1] + "/session.ctpm"}, folder()).code, 0);
  // The database holds the same rows, numbers as numbers.
  const ProgramOutcome python = testing::run({"/usr/bin/python3", "-c",
                                              "import sqlite3; c = sqlite3.connect('out/results.sqlite'); "
                                              "print(*c.execute('select count(*), sum(stiffness_scale), min(state), "
                                              "max(length(ticks_hash)), count(error) from sessions')"
                                              ".fetchone())"},
                                             folder());
  EXPECT_EQ(python.out, "6 7.0 done 16 0\n") << python.err;
  const std::string page = slurp(out() / "report.html");
  for (const char* part :
       {"All 6 sessions were recorded.", "rises most clearly with", " over the sessions, rank correlation ",
        "max_force_n by stiffness_scale", "Means by distance_mm"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST_F(SweepProgram, SaysAllMistakesWhereTheyAreAndWritesNothing) {
  testing::write_rig(folder());
  testing::write_sweep(folder(), R"("vary": [
  {"key": "/organs/0/material/stiffness_scale", "values": [1, -1]},
  {"key": "/organs/0/materiel", "values": [2]},
  {"key": "/organs/7/name", "values": ["a"]},
  {"of": "script", "name": "tool", "key": "/steps/0/take/tool", "values": ["pin", "hammer"]}])");
  ProgramOutcome planned = run({"plan", "sweep.json", "-o", "out"});
  EXPECT_EQ(planned.code, 2);
  EXPECT_NE(planned.err.find("rig.json:7:13: error: /organs: there is no /7/name"), std::string::npos) << planned.err;
  testing::write_sweep(folder(), R"("vary": [
  {"key": "/organs/0/material/stiffness_scale", "values": [1, -1]},
  {"key": "/organs/0/materiel", "values": [2]},
  {"of": "script", "name": "tool", "key": "/steps/0/take/tool", "values": ["pin", "hammer"]}])");
  planned = run({"plan", "sweep.json", "-o", "out"});
  EXPECT_EQ(planned.code, 2);
  for (const char* part : {"sweep.json:4:63: error: /vary/0/values/1: got -1, must be in ",
                           "sweep.json:5:44: error: /vary/1/values/0: ", "materiel",
                           "sweep.json:6:83: error: /vary/2/values/1: the scene has no tool \"hammer\""})
    EXPECT_NE(planned.err.find(part), std::string::npos) << part << "\nin\n" << planned.err;
  EXPECT_EQ(testing::lines_of(planned.err).size(), 3u) << planned.err;
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(SweepProgram, SaysAMissingFileWithEverythingElse) {
  testing::write_rig(folder());
  fs::remove(folder() / "press.json");
  const auto refused = [&](const std::string& vary, const std::vector<std::string>& parts) {
    testing::write_sweep(folder(), vary);
    const ProgramOutcome planned = run({"plan", "sweep.json", "-o", "rig.json"});
    EXPECT_EQ(planned.code, 2);
    for (const std::string& part : parts)
      EXPECT_NE(planned.err.find(part), std::string::npos) << part << "\nin\n" << planned.err;
    EXPECT_EQ(testing::lines_of(planned.err).size(), parts.size()) << planned.err;
  };
  const std::string missing = "press.json: error: does not exist", no_folder = "rig.json: error:";
  refused(R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": [1, -1]}])",
          {"/vary/0/values/1: got -1, must be in ", missing, no_folder});
  refused(R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": []}])", {"/vary/0", missing, no_folder});
  // Where the scene is missing, the script is judged as far as it can be.
  testing::write_rig(folder());
  fs::remove(folder() / "rig.json");
  testing::write(folder() / "press.json", R"({"format": "ctpm-script", "version": 1, "steps": [{"wait_s": -1}]})");
  refused(R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": [1, 2]}])",
          {"rig.json: error: does not exist", "/steps/0/wait_s: got -1"});
}

TEST_F(SweepProgram, ASliceOfNoSessionIsRefused) {
  testing::write_rig(folder());
  testing::write_sweep(folder(), R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": [1, 2]}])");
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  const ProgramOutcome refused = run({"run", "out", "--from", "3", "--to", "2"});
  EXPECT_EQ(refused.code, 2);
  for (const char* part : {"--from: error: is beyond --to", "--from: error: got 3, and the plan has 2 sessions"})
    EXPECT_NE(refused.err.find(part), std::string::npos) << refused.err;
  EXPECT_EQ(status(), "../out: 0 of 2 done, 2 waiting\n");
  // The last element of an array may reach beyond the plan.
  EXPECT_EQ(run({"run", "out", "--from", "2", "--to", "9"}).code, 0);
  EXPECT_EQ(status(), "../out: 1 of 2 done, 1 waiting\n");
}

TEST_F(SweepProgram, AFolderThatIsMissingIsToldFromOneWithoutAPlan) {
  fs::create_directory(folder() / "empty");
  for (const char* verb : {"run", "status", "collect", "retry"}) {
    const auto missing = run({verb, "nowhere"}), empty = run({verb, "empty"});
    EXPECT_EQ(missing.code, 2);
    EXPECT_NE(missing.err.find("nowhere: error: does not exist"), std::string::npos) << verb << ": " << missing.err;
    EXPECT_EQ(empty.code, 2);
    EXPECT_NE(empty.err.find("empty: error: holds no plan"), std::string::npos) << verb << ": " << empty.err;
  }
}

TEST_F(SweepProgram, GoesOnAfterEveryKill) {
  testing::write_rig(folder());
  testing::write_sweep(folder(), R"("method": "latin-hypercube", "samples": 60, "vary": [
    {"key": "/organs/0/material/stiffness_scale", "from": 0.5, "to": 4}])");
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "whole"}).code, 0);
  ASSERT_EQ(run({"run", "whole"}).code, 0);
  ASSERT_EQ(run({"collect", "whole"}).code, 0);
  std::size_t kills = 0;
  for (std::size_t wanted = 5; wanted < 60; wanted += 12, ++kills) {
    testing::RunningProgram program({"sweep", "run", "out", "--jobs", "2"}, folder());
    while (count_finished() < wanted) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }  // its end is a kill -9
  EXPECT_EQ(kills, 5u);
  const ProgramOutcome ran = run({"run", "out", "--jobs", "2"});
  EXPECT_EQ(ran.code, 0) << ran.out << ran.err;
  ASSERT_EQ(run({"collect", "out"}).code, 0);
  EXPECT_EQ(slurp(out() / "results.csv"), slurp(folder() / "whole" / "results.csv"));
  for (const auto& entry : fs::directory_iterator(out() / "tasks"))
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
}

TEST_F(SweepProgram, ASessionWhoseProcessIsKilledIsBegunAgainAndFailsAfterThreeTimes) {
  testing::write_rig(folder(), "100000");
  testing::write_sweep(folder(), R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": [1]}])");
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  testing::RunningProgram program({"sweep", "run", "out"}, folder());
  pid_t last = -1;
  for (int kill = 0; kill < 3; ++kill) {
    std::vector<pid_t> children;
    // The next process, once its session is there.
    while (children.empty() || children.front() == last || status() != "../out: 0 of 1 done, 1 running\n") {
      children = children_of(program.process());
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    last = children.front();
    ::kill(last, SIGKILL);
  }
  const ProgramOutcome ran = program.outcome();
  EXPECT_EQ(ran.code, 1) << ran.out;
  EXPECT_NE(ran.out.find("its process died 3 times, the last time of signal Killed"), std::string::npos) << ran.out;
  EXPECT_NE(ran.err.find("3 processes died"), std::string::npos) << ran.err;
  EXPECT_EQ(run({"retry", "out"}).out, "1 sessions that failed wait again\n");
  EXPECT_EQ(status(), "../out: 0 of 1 done, 1 waiting\n");
}

TEST_F(SweepProgram, StopsCleanlyAndShowsWhatWasKilled) {
  testing::write_rig(folder(), "100000");
  testing::write_sweep(folder(), R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": [1, 2]}])");
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  {
    testing::RunningProgram program({"sweep", "run", "out", "--jobs", "2"}, folder());
    while (status() != "../out: 0 of 2 done, 2 running\n") {
    }
  }
  while (status() != "../out: 0 of 2 done, 2 killed\n") {
  }
  testing::RunningProgram again({"sweep", "run", "out", "--jobs", "2"}, folder());
  while (status() != "../out: 0 of 2 done, 2 running\n") {
  }
  again.interrupt();
  const ProgramOutcome stopped = again.outcome();
  EXPECT_EQ(stopped.code, 1);
  EXPECT_NE(stopped.err.find("the same command goes on"), std::string::npos) << stopped.err;
  EXPECT_EQ(status(), "../out: 0 of 2 done, 2 waiting\n");
}

TEST_F(SweepProgram, KeepsFailedSessionsVisible) {
  testing::write_rig(folder());
  testing::write_sweep(folder(), R"("vary": [
    {"name": "x_mm", "key": "/organs/0/anchors/0/sphere/centre_mm", "values": [[-24, 0, 0], [-99, 0, 0]]}])");
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  const ProgramOutcome ran = run({"run", "out"});
  EXPECT_EQ(ran.code, 1);
  EXPECT_NE(ran.out.find("out: 1 of 2 done, 1 failed\nfailed: session 2, "), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("rig.json:24:9: error: /organs/0/anchors/0: holds no sphere (with x_mm = -99 0 0)"),
            std::string::npos)
      << ran.out;
  EXPECT_EQ(run({"collect", "out"}).code, 2);
  EXPECT_EQ(run({"collect", "out", "--incomplete"}).code, 1);
  const std::vector<std::string> rows = testing::lines_of(slurp(out() / "results.csv"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NE(rows[2].find(",failed,-99 0 0,,"), std::string::npos) << rows[2];
  const std::string page = slurp(out() / "report.html");
  EXPECT_NE(page.find("1 of 2 done, 1 failed."), std::string::npos);
  EXPECT_NE(page.find("Sessions without a result"), std::string::npos);
}

TEST_F(SweepProgram, AFailedSessionNamesTheLineOfTheAuthorsFileAndTheValues) {
  testing::write_rig(folder());
  // On one line the values before it move it in the session's text.
  std::string scene = slurp(folder() / "rig.json");
  std::replace(scene.begin(), scene.end(), '\n', ' ');
  testing::write(folder() / "rig.json", scene);
  testing::write_sweep(folder(), R"("vary": [{"key": "/organs/0/fill/gap_mm", "values": [4, 5.015625]}])");
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  const ProgramOutcome ran = run({"run", "out"});
  EXPECT_EQ(ran.code, 1);
  const std::string column = std::to_string(scene.find("{ \"sphere\": { \"centre_mm\": [-24") + 1);
  EXPECT_NE(ran.out.find("rig.json:1:" + column + ": error: /organs/0/anchors/0"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("(with gap_mm = 5.015625)"), std::string::npos) << ran.out;
}

TEST_F(SweepProgram, PlannedAgainKeepsWhatDidNotChangeAndRefusesWhatDid) {
  testing::write_rig(folder());
  testing::write_sweep(folder(), R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": [1, 2]}])");
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  ASSERT_EQ(run({"run", "out"}).code, 0);
  testing::write_sweep(folder(), R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": [2, 3]}])");
  EXPECT_EQ(run({"plan", "sweep.json", "-o", "out"}).out, "out: 2 sessions planned, of which 1 are done already\n");
  EXPECT_EQ(run({"run", "out"}).out.find("1 session in "), 0u);
  // Another script is another sweep: what is done stays, what is new is not what was planned.
  testing::write_sweep(folder(), R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": [2, 4]}])");
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  testing::write_rig(folder(), "0.2");
  const ProgramOutcome changed = run({"run", "out"});
  EXPECT_EQ(changed.code, 2);
  EXPECT_NE(changed.err.find("changed since it was planned"), std::string::npos) << changed.err;
  EXPECT_EQ(status(), "../out: 1 of 2 done, 1 waiting\n");
}

/// Two sessions of the rig, a.ctpm and b.ctpm, of which b has one bit flipped where its ticks are.
void record_two(const fs::path& folder) {
  testing::write_rig(folder);
  for (const char* name : {"a.ctpm", "b.ctpm"})
    ASSERT_EQ(testing::run_ctpm({"record", "rig.json", "--script", "press.json", "-o", name, "--fast"}, folder).code,
              0);
  const std::string bytes = slurp(folder / "b.ctpm");
  std::fstream file(folder / "b.ctpm", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(std::streamoff(bytes.size() / 2));
  file.put(char(bytes[bytes.size() / 2] ^ 1));
}

TEST_F(SweepProgram, RunsACommandOnEachSession) {
  record_two(folder());
  const ProgramOutcome planned = run({"plan", "--each", "verify", "-o", "out", "a.ctpm", "b.ctpm"});
  ASSERT_EQ(planned.code, 0) << planned.err;
  EXPECT_EQ(run({"run", "out"}).code, 1);
  EXPECT_EQ(status().find("../out: 1 of 2 done, 1 failed\nfailed: session 2, "), 0u) << status();
  const std::vector<std::string> rows = testing::lines_of(slurp(folder() / "out" / "manifest.csv"));
  const std::string first = testing::cells_of(rows.at(1)).at(1);
  EXPECT_NE(slurp(out() / "tasks" / first / "out.txt").find("same: "), std::string::npos);
  // Mended, it is another session: the plan is not that of the files any more.
  fs::copy_file(folder() / "a.ctpm", folder() / "b.ctpm", fs::copy_options::overwrite_existing);
  ASSERT_EQ(run({"retry", "out"}).code, 0);
  EXPECT_EQ(run({"run", "out"}).code, 2);
  ASSERT_EQ(run({"plan", "--each", "verify", "-o", "out", "a.ctpm", "b.ctpm"}).code, 0);
  EXPECT_EQ(run({"run", "out"}).out.find("1 session in "), 0u);
  EXPECT_EQ(run({"collect", "out"}).code, 0);
}

TEST_F(SweepProgram, ComparesAndExportsEachSession) {
  record_two(folder());
  fs::copy_file(folder() / "a.ctpm", folder() / "expert.ctpm");
  ASSERT_EQ(run({"plan", "--each", "compare expert.ctpm", "-o", "out", "a.ctpm"}).code, 0);
  const ProgramOutcome compared = run({"run", "out"});
  EXPECT_EQ(compared.code, 0) << compared.out << compared.err;
  ASSERT_EQ(run({"collect", "out"}).code, 0);
  const std::vector<std::string> rows = testing::lines_of(slurp(out() / "results.csv"));
  EXPECT_NE(rows.at(0).find(",exit_code,"), std::string::npos) << rows[0];
  EXPECT_NE(rows.at(0).find("force"), std::string::npos) << rows[0];
  ASSERT_EQ(run({"plan", "--each", "export --size 160x90 --fps 10 -o {out}/small.mp4", "-o", "films", "a.ctpm"}).code,
            0);
  const ProgramOutcome exported = run({"run", "films"});
  EXPECT_EQ(exported.code, 0) << exported.out << exported.err;
  const auto id = testing::cells_of(testing::lines_of(slurp(folder() / "films" / "manifest.csv")).at(1)).at(1);
  EXPECT_TRUE(fs::exists(folder() / "films" / "tasks" / id / "small.mp4"));
}

TEST_F(SweepProgram, WrongWordsOfACommandAreRefusedBeforeAThousandSessionsFail) {
  testing::write(folder() / "a.ctpm", "x");
  for (const auto& [command, said] :
       {std::pair("verify --wings", "--each: error: The following argument was not expected: --wings"),
        std::pair("export --fps fast", "--each: error: "), std::pair("compare", "--each: error: "),
        std::pair("compare none.ctpm", "none.ctpm: error: does not exist")}) {
    const ProgramOutcome planned = run({"plan", "--each", command, "-o", "out", "a.ctpm"});
    EXPECT_EQ(planned.code, 2) << command;
    EXPECT_NE(planned.err.find(said), std::string::npos) << planned.err;
  }
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(SweepProgram, RefusesCommandsThatReadNoSession) {
  testing::write(folder() / "a.ctpm", "x");
  const ProgramOutcome record = run({"plan", "--each", "record", "-o", "out", "a.ctpm"});
  EXPECT_EQ(record.code, 2);
  EXPECT_NE(record.err.find("one of compare, export, info, verify"), std::string::npos) << record.err;
  const ProgramOutcome twice = run({"plan", "--each", "verify", "-o", "out", "a.ctpm", "a.ctpm", "none.ctpm"});
  EXPECT_EQ(twice.code, 2);
  EXPECT_NE(twice.err.find("a.ctpm: error: is there twice"), std::string::npos) << twice.err;
  EXPECT_NE(twice.err.find("none.ctpm: error: does not exist"), std::string::npos) << twice.err;
  const ProgramOutcome empty = run({"plan", "--each", "", "-o", "out", "a.ctpm"});
  EXPECT_EQ(empty.code, 2);
  EXPECT_NE(empty.err.find("--each: error: needs a command"), std::string::npos) << empty.err;
  fs::create_directory(folder() / "sessions");
  const ProgramOutcome of_folder = run({"plan", "--each", "verify", "-o", "out", "sessions"});
  EXPECT_EQ(of_folder.code, 2);
  EXPECT_NE(of_folder.err.find("sessions: error: is a folder, not a file"), std::string::npos) << of_folder.err;
  EXPECT_FALSE(fs::exists(out()));
}

/// What follows "the sweep itself" in the output of a run [%].
double share_in(const std::string& out) {
  const std::string before = "of which the sweep itself ";
  return std::stod(out.substr(out.find(before) + before.size()));
}

TEST_F(SweepProgram, SlowCostsAtMostThreePercentOfAThousandSessions) {
  testing::write_rig(folder(), "2");
  testing::write_sweep(folder(), R"("method": "latin-hypercube", "samples": 1000, "vary": [
    {"key": "/organs/0/material/stiffness_scale", "from": 0.5, "to": 4},
    {"of": "script", "key": "/steps/1/press/distance_mm", "from": 1, "to": 6}])");
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  const ProgramOutcome ran = run({"run", "out"});
  ASSERT_EQ(ran.code, 0) << ran.out << ran.err;
  EXPECT_LE(share_in(ran.out), 3) << ran.out;
  EXPECT_NE(ran.out.find("out: 1000 of 1000 done"), std::string::npos) << ran.out;
}

}  // namespace
}  // namespace ctpm
