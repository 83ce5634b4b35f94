// Less that was done is no better for its lower force.

#include "studio/compare/reach.h"
#include "studio/compare/advice.h"
#include "studio/compare/report.h"
#include "tests/studio/compare/made_tracks.h"

namespace ctpm {
namespace {

class Reach : public Measures {};

TEST_F(Reach, LessThatWasDoneIsNotBetterForItsLowerForce) {
  const auto pressed = [&](double depth, double force) {
    compare::SessionTrack track = press();
    for (std::size_t i = 500; i < 1500; ++i) track.depth[i] = depth, track.force[i] = force;
    return track;
  };
  const auto cutting = [&](double depth, double area, double force) {
    compare::SessionTrack track = pressed(0, force);
    track.severed_at[0] = 10, track.severed[10] = 1, track.cuts = {{10, 11}};
    track.cut = session::CutSize{.depth = 0.01, .length = 0.03, .area = area, .along_blade = depth};
    return track;
  };
  const auto force_is = [&](const compare::SessionTrack& expert, const compare::SessionTrack& trainee) {
    const compare::Comparison comparison = compare::compare_sessions(expert, trainee, scene_);
    if (find(comparison, "mean_force_n").trainee) {
      EXPECT_EQ(compare::standing_of(find(comparison, "peak_force_n")),
                compare::standing_of(find(comparison, "mean_force_n")));
    }
    EXPECT_EQ(compare::less_done_text(comparison).empty(),
              compare::shortfalls_of(comparison.values, comparison.damage_depth).empty());
    return compare::standing_of(find(comparison, "peak_force_n"));
  };
  EXPECT_EQ(force_is(pressed(0.008, 2), pressed(0.0078, 1)), "better");
  EXPECT_EQ(force_is(pressed(0.008, 2), pressed(0.004, 1)), "less done");
  EXPECT_EQ(force_is(pressed(0.008, 2), pressed(0.004, 3)), "worse");
  EXPECT_EQ(force_is(pressed(0.008, 2), press()), "less done") << "nothing was pushed";
  EXPECT_EQ(force_is(cutting(0.01, 2e-4, 2), cutting(0.01, 2e-4, 1)), "better");
  EXPECT_EQ(force_is(cutting(0.01, 2e-4, 2), cutting(0.005, 2e-4, 1)), "less done");
  EXPECT_EQ(force_is(cutting(0.01, 2e-4, 2), cutting(0.01, 1e-4, 1)), "less done");
  EXPECT_EQ(force_is(cutting(0.01, 2e-4, 2), press()), "less done") << "nothing was cut";

  EXPECT_EQ(force_is(pressed(0.015, 2), pressed(0.008, 1)), "better") << "who harms the tissue sets no example";

  const compare::SessionTrack expert = pressed(0.008, 2), trainee = pressed(0.004, 1);
  const compare::Comparison comparison = compare::compare_sessions(expert, trainee, scene_);
  const recordings::SessionStart& scene = scene_;
  EXPECT_EQ(compare::advice_of({expert, trainee, scene, comparison}).at(0), "Push deeper: 4 mm, the expert 8 mm.");
  // A cut through most of an organ is as near to a surface as one that ends above its middle.
  const compare::SessionTrack cut = cutting(0.02, 2e-4, 1), nearly_through = cutting(0.04, 2e-4, 1);
  const compare::Comparison of_cuts = compare::compare_sessions(cut, nearly_through, scene_);
  EXPECT_EQ(compare::advice_of({cut, nearly_through, scene, of_cuts}).at(0), "Cut less deep: 40 mm, the expert 20 mm.");
  EXPECT_EQ(compare::standing_of(find(comparison, "economy_of_motion")), "same") << "it does not grow with the work";
}

}  // namespace
}  // namespace ctpm
