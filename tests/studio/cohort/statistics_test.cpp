// Numbers of tests/references/cohort.py, and curves whose answers are known.

#include "studio/cohort/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "studio/cohort/cohort.h"
#include "studio/cohort/stroke.h"
#include "studio/compare/measure_table.h"
#include "studio/output/random_numbers.h"

namespace ctpm {
namespace {

using cohort::LearningState;

const std::vector<double> kValues{3.1, 4.7, 2.2, 5.9, 4.4, 3.8, 6.3};

TEST(CohortStatistics, TheRandomNumbersAreThoseThatWerePublished) {
  EXPECT_EQ(output::random_at(1234567, 0), 6457827717110365317u);
  EXPECT_EQ(output::random_at(1234567, 1), 3203168211198807973u);
  EXPECT_EQ(output::random_at(1234567, 2), 9817491932198370423u);
}

TEST(CohortStatistics, IntervalsAreThoseOfTheReference) {
  const auto one = cohort::interval_of_mean(kValues, {.confidence = 0.95, .resamples = 2000, .seed = 1});
  const auto seven = cohort::interval_of_mean(kValues, {.confidence = 0.9, .resamples = 500, .seed = 7});
  ASSERT_TRUE(one && seven);
  EXPECT_NEAR(one->low, 3.35714285714286, 1e-13);
  EXPECT_NEAR(one->high, 5.35714285714286, 1e-13);
  EXPECT_NEAR(seven->low, 3.45714285714286, 1e-13);
  EXPECT_NEAR(seven->high, 5.17142857142857, 1e-13);
  EXPECT_FALSE(cohort::interval_of_mean(std::vector<double>{1.0}, {}));
}

TEST(CohortStatistics, ASpreadNeedsTwoValues) {
  const auto spread = cohort::spread_of(kValues);
  ASSERT_TRUE(spread);
  EXPECT_EQ(spread->count, 7u);
  EXPECT_NEAR(spread->mean, 4.34285714285714, 1e-13);
  EXPECT_NEAR(spread->deviation, 1.4615712354143, 1e-13);
  EXPECT_EQ(spread->low, 2.2);
  EXPECT_EQ(spread->high, 6.3);
  EXPECT_FALSE(cohort::spread_of(std::vector<double>{1.0}));
}

TEST(CohortStatistics, WhatDiffersByRoundingHasNoSpread) {
  EXPECT_EQ(cohort::spread_of(std::vector<double>{49.83, 49.83 * (1 + 3e-16), 49.83})->deviation, 0);
  EXPECT_EQ(cohort::spread_of(std::vector<double>{0.1 + 0.2, 0.3, 0.3})->deviation, 0);
  EXPECT_GT(cohort::spread_of(std::vector<double>{49.83, 49.83 * (1 + 1e-9)})->deviation, 0);
}

TEST(CohortStatistics, TheSumOfFailuresIsThatOfTheReferenceAndALimitThatIsMetCounts) {
  std::vector<bool> passed;
  for (const char c : std::string("0001011111111111111111111000")) passed.push_back(c == '1');
  const scenes::LearningSpec learning{.acceptable = 0.1, .unacceptable = 0.3, .false_alarm = 0.1, .missed = 0.1};
  const cohort::LearningLimits limits = cohort::limits_of(learning);
  EXPECT_NEAR(limits.learned, -1.62766211657933, 1e-13);
  EXPECT_NEAR(limits.failing, 1.62766211657933, 1e-13);
  EXPECT_NEAR(limits.pass, 0.186168941710336, 1e-13);
  EXPECT_NEAR(limits.failure, 1 - limits.pass, 1e-13);
  const std::vector<cohort::LearningStep> steps = cohort::learning_curve(passed, learning);
  ASSERT_EQ(steps.size(), 28u);
  EXPECT_NEAR(steps[1].sum, 1.62766211657933, 1e-13);
  EXPECT_NEAR(steps[21].sum, -1.72337883420671, 1e-13);
  EXPECT_NEAR(steps[24].sum, -0.558506825131007, 1e-13);
  EXPECT_NEAR(steps[27].sum, 1.88298634973799, 1e-13);
  const std::vector<std::pair<std::size_t, LearningState>> states{
      {0, LearningState::open},     {1, LearningState::failing},  {20, LearningState::failing},
      {21, LearningState::learned}, {26, LearningState::learned}, {27, LearningState::failing}};
  for (const auto& [attempt, state] : states) EXPECT_EQ(steps[attempt].state, state) << attempt;
}

TEST(CohortMarks, AnAttemptPassesWhereEveryMarkIsMetAndNoValueIsMissing) {
  scenes::TaskSpec task;
  task.marks = {{.measure = "peak_force_n", .low = {}, .high = {}, .pass_at_least = {}, .pass_at_most = 4},
                {.measure = "cut_depth_mm", .low = 0, .high = 9, .pass_at_least = {}, .pass_at_most = {}}};
  std::vector<std::string> missed;
  const auto judge = [&](std::optional<double> force) {
    missed.clear();
    return cohort::judge({{&compare::kPeakForce, force}, {&compare::kCutDepth, {}}}, task, missed);
  };
  EXPECT_EQ(judge(4.0), std::optional(true));
  EXPECT_EQ(judge(4.1), std::optional(false));
  EXPECT_EQ(missed, std::vector<std::string>{"peak_force_n"});
  EXPECT_EQ(judge({}), std::optional(false)) << "what was not measured is not passed";
  task.marks.erase(task.marks.begin());
  EXPECT_EQ(judge(1.0), std::nullopt) << "a declared range is no mark";
}

TEST(CohortMarks, TheShareOfOthersKnowsWhichValueIsBetter) {
  const std::vector<double> others{1, 2, 3, 4};
  using enum compare::Direction;
  EXPECT_EQ(cohort::share_no_better(2, others, lower, 0), 0.75);
  EXPECT_EQ(cohort::share_no_better(2, others, higher, 0), 0.5);
  EXPECT_EQ(cohort::share_no_better(2, others, nearer, 2.6), 0.75) << "2 and 4 are farther than 3, 1 farther still";
  EXPECT_FALSE(cohort::share_no_better(2, {}, lower, 0));
}

/// A way of 100 mm along x in a second, with a force that begins at a share of it.
struct Hand {
  compare::SessionTrack track;
  compare::TimedPath way;

  explicit Hand(double beside, double force_from, double pace = 1) {
    track.tick = 1e-3;
    const int ticks = int(1000 / pace);
    for (int i = 0; i <= ticks; ++i) {
      const double share = double(i) / ticks;
      track.tool.push_back(0), track.tip.push_back({0.1 * share, beside, 0});
      track.force.push_back(share >= force_from ? 2.0 : 0.0);
      track.depth.push_back(0), track.severed.push_back(0);
    }
    track.strokes = {{0, track.tick_count()}};
    way = compare::tool_path(track);
  }
  cohort::StrokeCurve along(const Hand& reference) const {
    return cohort::stroke_curve(reference.way, compare::align_paths(reference.way.place, way.place), way, track);
  }
};

TEST(CohortStroke, WhatHappensIsFoundWhereItIsAlongTheWayWhateverThePace) {
  const Hand reference(0, 0.5);
  for (const double pace : {1.0, 0.5}) {
    const cohort::StrokeCurve curve = Hand(0.003, 0.25, pace).along(reference);
    ASSERT_EQ(curve.place.size(), cohort::kStrokePlaces);
    for (const std::size_t at : {0u, 40u, 100u}) EXPECT_NEAR(curve.place[at].x, 1e-3 * double(at), 2e-3) << pace;
    EXPECT_EQ(curve.force[20], 0) << pace;
    EXPECT_EQ(curve.force[30], 2) << pace;
  }
}

TEST(CohortStroke, TheStretchBeyondTheBandIsTheOneThatWeighsMost) {
  const Hand reference(0, 0.5), left(-0.001, 0.5), right(0.001, 0.5);
  const std::vector<cohort::StrokeCurve> experts{reference.along(reference), left.along(reference),
                                                 right.along(reference)};
  const std::vector<Vec3> middle = cohort::middle_of(experts);
  EXPECT_NEAR(middle[50].y, 0, 1e-12);
  std::vector<std::vector<double>> distances, forces;
  for (const cohort::StrokeCurve& curve : experts)
    distances.push_back(cohort::distance_from(middle, curve)), forces.push_back(curve.force);
  const cohort::StrokeBand band = cohort::band_of(distances);
  EXPECT_NEAR(band.mean[50], 2e-3 / 3, 1e-12);
  EXPECT_NEAR(band.deviation[50], std::sqrt(1.0 / 3) * 1e-3, 1e-12);
  const cohort::StrokeCurve early = Hand(0.004, 0.25).along(reference);
  const cohort::StrokeExcess far = cohort::excess_of(cohort::distance_from(middle, early), band, 1e-4);
  EXPECT_TRUE(far.any && far.from == 0 && far.to == 100);
  EXPECT_NEAR(far.value, 4e-3, 1e-9);
  const cohort::StrokeExcess force = cohort::excess_of(early.force, cohort::band_of(forces), 0.01);
  ASSERT_TRUE(force.any);
  EXPECT_NEAR(double(force.from), 25, 2);
  EXPECT_NEAR(double(force.to), 47, 2) << "up to two places before the experts' force";
  EXPECT_FALSE(cohort::excess_of(experts[1].force, cohort::band_of(forces), 0.01).any);
}

}  // namespace
}  // namespace ctpm
