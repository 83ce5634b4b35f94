// A sweep on a real Slurm, whose node and controller are killed while it runs.

#include "tests/studio/sweep/cluster.h"

#include <gtest/gtest.h>

namespace ctpm {
namespace {

namespace fs = std::filesystem;
using testing::Cluster;
using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::slurp;

std::string samples(std::size_t count) {
  return R"("method": "latin-hypercube", "samples": )" + std::to_string(count) + R"(, "vary": [
    {"key": "/organs/0/material/stiffness_scale", "from": 0.5, "to": 4},
    {"of": "script", "key": "/steps/1/press/distance_mm", "from": 1, "to": 6}])";
}

class SweepOnACluster : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string reason = Cluster::why_not(); !reason.empty()) GTEST_SKIP() << reason;
  }
  ProgramOutcome run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "sweep");
    return run_ctpm(arguments, folder());
  }
  std::size_t count_finished() const {
    std::size_t count = 0;
    std::error_code not_yet;
    for (const auto& entry : fs::directory_iterator(folder() / "out" / "tasks", not_yet))
      count += entry.path().filename().string().front() != '.';
    return count;
  }
  bool wait_for(std::size_t finished) const {
    return Cluster::within_a_minute([&] { return count_finished() >= finished; });
  }
  const fs::path& folder() const { return temporary_.path(); }
  /// A sweep of so many sessions, in 20 elements, ends with all rows after two kills of the node and one of the
  /// controller.
  void end_after_kills(std::size_t sessions);

 private:
  /// All sessions are written to last, which a disk is slow at: they lie in memory where that has room.
  struct InMemory {
    InMemory() {
      constexpr std::uintmax_t kRoom = 256 << 20;
      std::error_code none;
      if (const fs::space_info memory = fs::space("/dev/shm", none); !none && memory.available >= kRoom)
        setenv("TMPDIR", "/dev/shm", 1);
    }
  } in_memory_;
  testing::TemporaryFolder temporary_;
};

void SweepOnACluster::end_after_kills(std::size_t sessions) {
  const std::string all_of_them = std::to_string(sessions), of_element = std::to_string(sessions / 20);
  testing::write_rig(folder());
  testing::write_sweep(folder(), samples(sessions));
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "out"}).code, 0);
  ASSERT_EQ(run({"plan", "sweep.json", "-o", "here"}).code, 0);
  Cluster cluster(25);
  ASSERT_TRUE(cluster.is_ready()) << slurp(cluster.path() / "slurmctld.out") << slurp(cluster.path() / "slurmd.out");

  const std::string too_few = std::to_string(sessions / 50);
  const ProgramOutcome too_many = run({"run", "out", "--slurm", "--tasks-per-element", too_few});
  EXPECT_EQ(too_many.code, 2);
  EXPECT_NE(too_many.err.find("--tasks-per-element: error: got " + too_few +
                              ", which makes more elements than Slurm's MaxArraySize of 25"),
            std::string::npos)
      << too_many.err;
  const ProgramOutcome nowhere = run({"run", "out", "--slurm", "--partition", "none-such"});
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_NE(nowhere.err.find("invalid partition specified: none-such"), std::string::npos) << nowhere.err;

  const ProgramOutcome submitted =
      run({"run", "out", "--slurm", "--tasks-per-element", of_element, "--partition", "all", "--time", "10"});
  ASSERT_EQ(submitted.code, 0) << submitted.err;
  EXPECT_NE(submitted.out.find(": " + all_of_them + " sessions in 20 elements of up to " + of_element + "\n"),
            std::string::npos)
      << submitted.out;
  for (const std::size_t finished : {sessions * 11 / 100, sessions * 33 / 100}) {
    ASSERT_TRUE(wait_for(finished)) << count_finished();
    cluster.kill_node();
    EXPECT_LT(count_finished(), sessions);
    // As long as it takes to boot. Jobs that are younger than Slurm's BatchStartTimeout and MessageTimeout together are
    // missed only when the node is asked again, which takes 20 s.
    std::this_thread::sleep_for(std::chrono::seconds(4));
    cluster.start_node();
  }
  ASSERT_TRUE(wait_for(sessions * 55 / 100)) << count_finished();
  cluster.kill_controller();
  EXPECT_LT(count_finished(), sessions);
  cluster.start_controller();
  const auto is_complete = [&] { return cluster.tidy_up(), count_finished() == sessions; };
  bool all = false;
  for (int minute = 0; minute < 4 && !all; ++minute) all = Cluster::within_a_minute(is_complete);
  ASSERT_TRUE(all) << run({"status", "out"}).out << slurp(cluster.path() / "slurmctld.out");
  EXPECT_EQ(run({"run", "out", "--slurm"}).out, "out: nothing waits\n");

  ASSERT_EQ(run({"collect", "out"}).code, 0);
  const std::string rows = slurp(folder() / "out" / "results.csv");
  EXPECT_EQ(testing::lines_of(rows).size(), sessions + 1);
  ASSERT_EQ(run({"run", "here"}).code, 0);
  ASSERT_EQ(run({"collect", "here"}).code, 0);
  EXPECT_EQ(rows, slurp(folder() / "here" / "results.csv"));
}

TEST_F(SweepOnACluster, EndsWithAllRowsAfterTwoKillsOfTheNodeAndOneOfTheController) { end_after_kills(300); }

TEST_F(SweepOnACluster, SlowEndsWithAThousandRows) { end_after_kills(1000); }

TEST(SweepWithoutACluster, SaysThatSlurmIsMissing) {
  const testing::TemporaryFolder folder;
  testing::write_rig(folder.path());
  testing::write_sweep(folder.path(), R"("vary": [{"key": "/organs/0/material/stiffness_scale", "values": [1]}])");
  ASSERT_EQ(run_ctpm({"sweep", "plan", "sweep.json", "-o", "out"}, folder.path()).code, 0);
  const ProgramOutcome outcome =
      testing::run({"/usr/bin/env", "PATH=/nowhere", CTPM_PROGRAM, "sweep", "run", "out", "--slurm"}, folder.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("scontrol: error: cannot be started"), std::string::npos) << outcome.err;
  EXPECT_EQ(run_ctpm({"sweep", "run", "out", "--memory", "1G"}, folder.path()).code, 2);
}

}  // namespace
}  // namespace ctpm
