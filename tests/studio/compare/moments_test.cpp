// The worst moments, and what to do better: harm first, and nobody is blamed for the way to the work.

#include "studio/compare/moments.h"
#include "studio/compare/advice.h"
#include "studio/compare/report.h"
#include "tests/studio/compare/made_tracks.h"

namespace ctpm {
namespace {

class WorstMoments : public Measures {
 protected:
  static std::vector<compare::MomentKind> kinds_of(const compare::Comparison& comparison) {
    std::vector<compare::MomentKind> kinds;
    for (const compare::Moment& moment : comparison.moments) kinds.push_back(moment.kind);
    return kinds;
  }

  /// Five ways down and up, at the end of each of which it rests.
  compare::SessionTrack with_rests(double rest_s) const {
    const Vec3 above{0, 0, 0.1}, below{0, 0, 0.05};
    compare::SessionTrack track = new_track();
    for (int i = 0; i < 5; ++i) {
      go(track, i % 2 ? below : above, i % 2 ? above : below, 1);
      go(track, track.tip.back(), track.tip.back(), rest_s);
    }
    return finished(track, scene_.model);
  }
};

TEST_F(WorstMoments, TheWayToTheWorkIsNotBlamed) {
  const auto touching = [&] {
    compare::SessionTrack track = press();
    for (std::size_t i = 800; i < 1200; ++i) track.force[i] = 1;
    return track;
  };
  compare::SessionTrack track = touching();  // from where a program put it, and away to the side
  for (std::size_t i = 0; i < track.tick_count(); ++i)
    if (i < 600 || i > 1400) track.tip[i].x += 0.0245;
  const compare::Comparison comparison = compare::compare_sessions(touching(), track, scene_);
  EXPECT_TRUE(comparison.moments.empty()) << comparison.moments.front().from_s;
  EXPECT_GT(trainee(comparison, "aligned_deviation_largest_mm"), 24) << "the measure is of the whole way";

  for (Vec3& tip : track.tip) tip.x = 0.0245;
  const compare::Comparison off = compare::compare_sessions(touching(), track, scene_);
  ASSERT_EQ(kinds_of(off), std::vector{compare::MomentKind::deviation});
  EXPECT_NEAR(off.moments[0].from_s, 0.8, 0.021);
  EXPECT_NEAR(off.moments[0].to_s, 1.2, 0.021);
  // Who waits is out of step with the expert for longer than paths are aligned, and at the right place.
  compare::SessionTrack late = new_track();
  go(late, {0, 0, 0.1}, {0, 0, 0.1}, 20);
  const compare::SessionTrack then = touching();
  go(late, {0, 0, 0.1}, {0, 0, 0.05}, 1), go(late, {0, 0, 0.05}, {0, 0, 0.1}, 1);
  std::ranges::copy(then.force, late.force.begin() + 20000);
  const compare::Comparison waited = compare::compare_sessions(then, finished(late, scene_.model), scene_);
  EXPECT_GT(trainee(waited, "aligned_deviation_largest_mm"), 10);
  EXPECT_TRUE(waited.moments.empty()) << "who reads the task does not pause in it";
  // Where the expert never touches, the way through the air is the work.
  EXPECT_EQ(compare::compare_sessions(press(), track, scene_).moments.at(0).from_s, 0);
}

TEST_F(WorstMoments, APauseIsOneFromTheFirstMotionToTheLastTouch) {
  const auto rests = [&](double before, double within, double after) {
    compare::SessionTrack track = new_track();
    const Vec3 above{0, 0, 0.1}, below{0, 0, 0.05};
    go(track, above, above, before), go(track, above, below, 1), go(track, below, below, within);
    const std::size_t end = track.tick_count();
    go(track, below, above, 1), go(track, above, above, after);
    std::fill(track.force.begin() + std::ptrdiff_t(1e3 * before + 500), track.force.begin() + std::ptrdiff_t(end), 0.5);
    return finished(track, scene_.model);
  };
  const auto moments = [&](const compare::SessionTrack& expert, const compare::SessionTrack& track) {
    return compare::compare_sessions(expert, track, scene_, {.force_limit = 1}).moments;
  };
  EXPECT_TRUE(moments(rests(0, 0, 0), rests(5, 0, 5)).empty());
  compare::SessionTrack hesitates = new_track();
  const Vec3 above{0, 0, 0.1}, half{0, 0, 0.08}, below{0, 0, 0.05};
  go(hesitates, above, half, 0.5), go(hesitates, half, half, 2), go(hesitates, half, below, 0.5);
  hesitates.force.back() = 0.5;
  EXPECT_EQ(moments(rests(0, 0, 0), finished(hesitates, scene_.model)).size(), 1u) << "before the first touch";
  // What the expert waited outside of the work allows nobody to rest in it.
  for (const auto& expert : {rests(0, 0, 0), rests(9, 0, 9)}) {
    const std::vector<compare::Moment> found = moments(expert, rests(5, 3, 5));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, compare::MomentKind::pause);
    EXPECT_NEAR(found[0].from_s, 6, 0.02);
    EXPECT_NEAR(found[0].to_s, 9, 0.02);
    EXPECT_EQ(found[0].limit, 1);
  }
}

TEST_F(WorstMoments, APressThatIsTooDeepIsSaidOnceAndNotAsOffThePathBelowIt) {
  using enum compare::MomentKind;
  // Into tissue from z = 0.07 m on, so deep as the tip is below that.
  const auto pressed = [&](double to_z, double aside = 0) {
    compare::SessionTrack track = new_track();
    const Vec3 above{0, 0, 0.1}, below{aside, 0, to_z};
    go(track, above, below, 1), go(track, below, above, 1);
    for (std::size_t i = 0; i < track.tick_count(); ++i) {
      track.depth[i] = std::max(0.0, 0.07 - track.tip[i].z);
      track.force[i] = 100 * track.depth[i];
    }
    return finished(track, scene_.model);
  };
  const compare::SessionTrack expert = pressed(0.068), deep = pressed(0.05);  // 2 and 20 mm deep, where 10 are borne
  const recordings::SessionStart& scene = scene_;
  const auto compared = [&](const compare::SessionTrack& track, double force_limit) {
    return compare::compare_sessions(expert, track, scene, {.force_limit = force_limit});
  };
  const compare::Comparison below = compared(deep, 10);
  ASSERT_LT(below.path_limit, 0.0075) << "9.5 mm deep, and deeper, is off a path of 2 mm";
  EXPECT_EQ(kinds_of(below), std::vector{depth});
  const std::vector<std::string> advice = compare::advice_of({expert, deep, scene, below});
  ASSERT_EQ(advice.size(), 1u);
  EXPECT_EQ(advice[0].find("Push less deep"), 0u) << advice[0];
  // So it is of one that presses too hard; within all limits it is off the path, and nothing else says so.
  EXPECT_EQ(kinds_of(compared(pressed(0.0605), 0.9)), std::vector{force});
  EXPECT_EQ(kinds_of(compared(pressed(0.0605), 10)), std::vector{deviation});
  // Who is beside the path, too, is told both.
  EXPECT_EQ(kinds_of(compared(pressed(0.05, 0.03), 10)), (std::vector{depth, deviation}));
}

TEST_F(WorstMoments, HarmComesBeforePausesAndNoKindFillsTheList) {
  using enum compare::MomentKind;
  compare::SessionTrack expert = with_rests(0), track = with_rests(2.5);
  const auto sever = [](compare::SessionTrack& by, std::size_t first, std::size_t count, std::size_t tick) {
    for (std::size_t i = first; i < first + count; ++i) by.severed_at[i] = std::int64_t(tick);
    by.severed[tick] = std::int32_t(count), by.cuts = {{tick, tick + 1}};
  };
  sever(expert, 0, 12, 700), sever(track, 12, 10, 700);
  for (std::size_t press = 0; press < 4; ++press)
    for (std::size_t i = 0; i < 100; ++i) track.force[3500 * press + 500 + i] = 4 + double(press);
  track.force.back() = 0.1;  // the last pause is in the work, too
  track.zones = {"vessel"}, track.zone.assign(track.tick_count(), -1);
  std::fill_n(track.zone.begin() + 200, 50, 0);

  const compare::Comparison comparison = compare::compare_sessions(expert, track, scene_, {.force_limit = 2});
  EXPECT_EQ(kinds_of(comparison),
            (std::vector{zone, force, force, stray_cut, force, pause, pause, pause, force, pause, pause}));
  EXPECT_EQ(comparison.moments.at(1).value, 7) << "of one concern the farthest beyond its limit comes first";
  EXPECT_EQ(comparison.moments.at(8).value, 4);

  const recordings::SessionStart& scene = scene_;
  const std::vector<std::string> advice = compare::advice_of({expert, track, scene, comparison});
  ASSERT_EQ(advice.size(), 5u);
  EXPECT_EQ(advice[0], "Keep out of forbidden zones: 0.05 s in vessel at 0.20 s.");
  const char* const begins[]{"Keep out", "Complete the cut", "Press more gently: 7 N", "Cut only where", "Go on"};
  for (std::size_t i = 0; i < advice.size(); ++i) EXPECT_EQ(advice[i].find(begins[i]), 0u) << advice[i];
}

TEST_F(WorstMoments, OfAScratchItIsSaidFirstThatTheCutIsMissingAndLastThatItsRimIsBesideTheExperts) {
  const auto cutting = [&](std::size_t first, std::size_t count, double along_blade) {
    compare::SessionTrack track = with_rests(0);
    for (std::size_t i = first; i < first + count; ++i) track.severed_at[i] = 700;
    track.severed[700] = std::int32_t(count), track.cuts = {{700, 701}};
    track.cut.emplace();
    track.cut->along_blade = along_blade;
    return track;
  };
  const compare::SessionTrack expert = cutting(0, 88, 0.0226), scratch = cutting(78, 12, 0.0023);
  const compare::Comparison comparison = compare::compare_sessions(expert, scratch, scene_);
  const recordings::SessionStart& scene = scene_;
  const std::vector<std::string> advice = compare::advice_of({expert, scratch, scene, comparison});
  ASSERT_EQ(advice.size(), 3u) << advice[0];
  EXPECT_EQ(advice[0], "Cut deeper: 2.3 mm, the expert 22.6 mm.");
  EXPECT_EQ(advice[1].find("Complete the cut: 78 of the 88"), 0u) << advice[1];
  EXPECT_EQ(advice[2].find("Cut only where the expert cut: 2 severed"), 0u) << advice[2];
}

TEST_F(WorstMoments, ALimitThatIsAsGoodAsKeptComesLast) {
  using enum compare::MomentKind;
  compare::SessionTrack track = with_rests(1.5);
  track.force.back() = 0.1;
  std::fill_n(track.force.begin(), 900, 2.08);
  const auto kinds = [&] {
    return kinds_of(compare::compare_sessions(with_rests(0), track, scene_, {.force_limit = 2}));
  };
  EXPECT_EQ(kinds(), (std::vector{pause, pause, pause, pause, pause, force}));
  std::fill_n(track.force.begin(), 900, 2.2);
  EXPECT_EQ(kinds().front(), force);
}

}  // namespace
}  // namespace ctpm
