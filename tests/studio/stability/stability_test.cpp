// Cases are judged as they should be, and the command says so.

#include <gtest/gtest.h>

#include <algorithm>

#include "studio/stability/stability.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using testing::ProgramOutcome;
using testing::run_ctpm;
using testing::slurp;
using testing::TemporaryFolder;

stability::StabilityCase case_named(const std::string& key) {
  const std::vector<stability::StabilityCase> cases = stability::stability_cases(true);
  const auto it =
      std::find_if(cases.begin(), cases.end(), [&](const stability::StabilityCase& c) { return c.key == key; });
  EXPECT_NE(it, cases.end()) << key;
  return *it;
}

TEST(Stability, ACaseThatHoldsIsMet) {
  const stability::StabilityRun run = stability::run_stability_case(case_named("stiffness-1"), std::nullopt);
  EXPECT_EQ(run.verdict, reports::ReportVerdict::met) << run.reason;
  EXPECT_EQ(run.ticks, 1000);
  EXPECT_GT(run.reach, 4e-3);
  EXPECT_EQ(run.distance.x.size(), run.energy.y.size());
}

TEST(Stability, ASphereThatLeavesItsBoundsIsMissed) {
  stability::StabilityCase what = case_named("stiffness-1");
  what.reach = 2e-3;  // it is pressed 6 mm
  const stability::StabilityRun run = stability::run_stability_case(what, std::nullopt);
  EXPECT_EQ(run.verdict, reports::ReportVerdict::missed);
  EXPECT_NE(run.reason.find("more than 2 mm"), std::string::npos) << run.reason;
}

TEST(Stability, EnergyThatGrowsIsMissed) {
  stability::StabilityCase what = case_named("stiffness-1");
  what.free_from = 0;  // the ball has not come yet, and will do work
  const stability::StabilityRun run = stability::run_stability_case(what, std::nullopt);
  EXPECT_EQ(run.verdict, reports::ReportVerdict::missed);
  EXPECT_NE(run.reason.find("energy grew"), std::string::npos) << run.reason;
}

TEST(Stability, WhatDoesNotComeToRestIsMissed) {
  stability::StabilityCase what = case_named("swing-mass-spring");
  what.end_speed = 1e-3;  // springs without dashpots go on swinging
  const stability::StabilityRun run = stability::run_stability_case(what, std::nullopt);
  EXPECT_EQ(run.verdict, reports::ReportVerdict::missed);
  EXPECT_NE(run.reason.find("rest"), std::string::npos) << run.reason;
}

TEST(Stability, WhatRanAndThenFailedIsMissedEvenIfItWasAnnounced) {
  const stability::StabilityRun run = stability::run_stability_case(case_named("stiffness-1"), Integrator::sdirk2);
  EXPECT_EQ(run.verdict, reports::ReportVerdict::missed);
  EXPECT_GT(run.ticks, 1);
  EXPECT_NE(run.reason.find("no numerical damping"), std::string::npos) << run.reason;
  EXPECT_NE(run.reason.find("does not come to rest"), std::string::npos) << run.reason;
}

TEST(Stability, BodiesThatAreAbusedSpinAndMeetAreAmongTheCases) {
  for (const char* key : {"recovery-press", "recovery-stroke", "spin", "meeting-fall", "meeting-collision"}) {
    const stability::StabilityCase what = case_named(key);
    const Model model = what.build();
    EXPECT_FALSE(model.surfaces.at(0).vertex.empty()) << key;
    EXPECT_TRUE(bool(what.also)) << key;
  }
}

TEST(Stability, ASpinThatLosesItsMomentumIsMissed) {
  const stability::StabilityCase what = case_named("spin");
  const stability::StabilityRun slow = stability::run_stability_case(what, Integrator::backward_euler);
  EXPECT_EQ(slow.verdict, reports::ReportVerdict::missed);
  EXPECT_NE(slow.reason.find("angular momentum changed"), std::string::npos) << slow.reason;
}

TEST(Stability, ManySpheresRunUntilTheyAnswer) {
  const stability::StabilityCase what = case_named("many-4096");
  EXPECT_GE(what.ticks, 500);
  EXPECT_GT(what.free_from, 0);
}

TEST(Stability, BadInputThatIsTakenIsMissed) {
  stability::StabilityCase what = case_named("stiffness-1");
  what.is_bad_input = [](std::int64_t tick) { return tick == 7; };  // it is good
  const stability::StabilityRun run = stability::run_stability_case(what, std::nullopt);
  EXPECT_EQ(run.verdict, reports::ReportVerdict::missed);
  EXPECT_EQ(run.ticks, 7);
}

TEST(Stability, AnIntegratorThatSaysItCannotIsRefusedIfItWasNamed) {
  const stability::StabilityRun run = stability::run_stability_case(case_named("stiffness-1"), Integrator::leapfrog);
  EXPECT_EQ(run.verdict, reports::ReportVerdict::refused);
  EXPECT_EQ(run.ticks, 0);
  EXPECT_NE(run.reason.find("ms"), std::string::npos) << run.reason;
}

TEST(Stability, NoIntegratorTakesWhatABrokenDeviceSends) {
  const stability::StabilityCase what = case_named("device-nan");
  for (const std::optional<Integrator> integrator : stability::kStabilityIntegrators) {
    const stability::StabilityRun run = stability::run_stability_case(what, integrator);
    EXPECT_NE(run.verdict, reports::ReportVerdict::missed) << stepping::name_of(integrator) << ": " << run.reason;
  }
}

TEST(Stability, KeysNameOneCaseEach) {
  for (const bool is_quick : {true, false}) {
    std::vector<std::string> keys;
    for (const stability::StabilityCase& what : stability::stability_cases(is_quick)) keys.push_back(what.key);
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
    EXPECT_GT(keys.size(), 30u);
  }
}

TEST(StabilityCommand, WritesAReportOfTheCasesThatAreAskedFor) {
  const TemporaryFolder folder;
  const ProgramOutcome outcome = run_ctpm(
      {"stability", "-o", "out", "--quick", "--case", "single", "--case", "empty", "--case", "chain"}, folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("3 cases: auto holds 3 and fails 0"), std::string::npos) << outcome.out;
  const std::string csv = slurp(folder.path() / "out/results.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 4);
  EXPECT_NE(csv.find("chain,"), std::string::npos);
  const std::string page = slurp(folder.path() / "out/report.html");
  EXPECT_LT(page.find("auto holds all 3 cases"), page.find("Must hold: every case"));
  EXPECT_LT(page.find("Only shown: integrators that are named. Of their runs "), page.find("<table"));
  EXPECT_NE(slurp(folder.path() / "out/results.json").find("\"failures_under_auto\": 0"), std::string::npos);
}

TEST(StabilityCommand, SpeaksOfOneCaseAsOne) {
  const TemporaryFolder folder;
  const ProgramOutcome outcome = run_ctpm({"stability", "-o", "out", "--quick", "--case", "single"}, folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("1 case: auto holds 1 and fails 0"), std::string::npos) << outcome.out;
  EXPECT_NE(slurp(folder.path() / "out/report.html").find("auto holds the one case."), std::string::npos);
}

TEST(StabilityCommand, RunsWhatAutoTakesAloneWhereThatIsAsked) {
  const TemporaryFolder folder;
  const ProgramOutcome outcome = run_ctpm(
      {"stability", "-o", "out", "--quick", "--auto-only", "--case", "single", "--case", "chain"}, folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("2 cases: auto holds 2 and fails 0"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("integrators that are named"), std::string::npos) << outcome.out;
  const std::string csv = slurp(folder.path() / "out/results.csv"), page = slurp(folder.path() / "out/report.html");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3) << csv;
  EXPECT_EQ(page.find("Only shown: integrators that are named"), std::string::npos);
}

TEST(StabilityCommand, NamesCasesThatDoNotExist) {
  const TemporaryFolder folder;
  const ProgramOutcome outcome =
      run_ctpm({"stability", "-o", "out", "--case", "nothing", "--case", "neither"}, folder.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("nothing"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("neither"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace ctpm
