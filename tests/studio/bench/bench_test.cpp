// Errors, percentiles and fronts are what they should be, and the command shows them.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "studio/bench/bench.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::slurp;
using testing::TemporaryFolder;

TEST(Bench, TheFrontHoldsWhatNothingElseBeatsInBoth) {
  const std::vector<double> cost{3, 1, 2, 4, 1}, error{0.1, 0.5, 0.6, 0.2, 0.4};
  // Fastest first: the more accurate of the two that cost 1, then what costs more and errs less.
  EXPECT_EQ(bench::pareto_front(cost, error), (std::vector<std::size_t>{4, 0}));
  EXPECT_TRUE(bench::pareto_front({}, {}).empty());
}

TEST(Bench, PercentilesAreValuesThatWereMeasured) {
  std::vector<double> values;
  for (int i = 1000; i >= 1; --i) values.push_back(i);
  EXPECT_EQ(bench::percentile(values, 0.5), 500);
  EXPECT_EQ(bench::percentile(values, 0.99), 990);
  EXPECT_EQ(bench::percentile(values, 0.999), 999);
  EXPECT_EQ(bench::percentile({7}, 0.999), 7);
  EXPECT_EQ(bench::percentile({}, 0.5), 0);
}

/// A run of one sphere that goes along x, `off` [m] away from where it should be.
bench::BenchRun straight_run(double off) {
  bench::BenchRun run;
  for (int t = 1; t <= 10; ++t) {
    Vec3Array p;
    p.push_back({0.01 * t + off, 0, 0});
    run.position.push_back(p), run.force.push_back({0, 0, 2 + 100 * off});
  }
  return run;
}

TEST(Bench, ErrorsAreRelativeToHowFarItMovesAndHowHardItPushes) {
  Vec3Array rest;
  rest.push_back({});
  double squares = 0;
  for (int t = 1; t <= 10; ++t) squares += 1e-4 * t * t;
  const bench::BenchRun reference = straight_run(0), off = straight_run(1e-3);
  EXPECT_EQ(bench::position_error(reference, reference, rest), 0);
  EXPECT_NEAR(bench::position_error(off, reference, rest), std::sqrt(10 * 1e-6 / squares), 1e-12);
  EXPECT_NEAR(bench::force_error(off, reference), 0.1 / 2, 1e-12);
}

TEST(BenchCommand, ShowsErrorAgainstRunTimeOfAScene) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "small.json") << R"({
    "format": "ctpm-scene", "version": 1, "name": "small",
    "organs": [{ "name": "block", "rig": { "block": [3, 3, 3] }, "model": "ctpm",
                 "fill": { "radius_mm": 4, "gap_mm": 4 }, "material": { "preset": "liver" },
                 "anchors": [{ "lowest_mm": 0 }] }],
    "tools": [{ "name": "ball", "kind": "ball", "radius_mm": 10 }] })";
  const ProgramOutcome outcome = run_ctpm({"bench", "small.json", "-o", "out", "--quick"}, folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("on this machine"), std::string::npos) << outcome.out;
  const std::string csv = slurp(folder.path() / "out/results.csv");
  EXPECT_NE(csv.find("backward-euler,4"), std::string::npos) << csv;
  EXPECT_NE(csv.find("sdirk2,2"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",front"), std::string::npos) << csv;
  const std::string page = slurp(folder.path() / "out/report.html");
  EXPECT_NE(page.find("Pareto front"), std::string::npos);
  EXPECT_NE(page.find("Observed order"), std::string::npos);
  EXPECT_NE(slurp(folder.path() / "out/results.json").find("ctpm-bench-results"), std::string::npos);
}

TEST(BenchCommand, ASceneWithoutABallIsRefusedWithItsName) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "bare.json") << R"({
    "format": "ctpm-scene", "version": 1, "name": "bare",
    "organs": [{ "name": "block", "rig": { "block": [3, 3, 3] }, "material": { "preset": "liver" },
                 "anchors": [{ "lowest_mm": 0 }] }] })";
  const ProgramOutcome outcome = run_ctpm({"bench", "bare.json", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("bare.json"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("ball"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace ctpm
