// Session files as they are read to be compared.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/stepping/step.h"
#include "recordings/session_writer.h"
#include "studio/compare/measure_table.h"
#include "studio/compare/measures.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

TEST(SameScene, ADifferenceIsNamedAndLooksMayDiffer) {
  const testing::Folder folder;
  const auto opened = [&](const std::string& name, const recordings::SessionStart& start) {
    testing::record_session(folder / name, start, 10);
    auto reader = recordings::SessionReader::open(folder / name);
    CTPM_CHECK(bool(reader), "a test's session opens");
    return std::move(*reader);
  };
  const recordings::SessionStart start = testing::small_start();
  recordings::SessionStart other_look = start, softer = start, larger = testing::small_start(3, 3, 4),
                           other_tool = start;
  other_look.look = "block blue", other_look.scene_text = "{}";
  softer.model.axial.k[7] *= 0.5;
  other_tool.model.tools[0].name = "fist";
  const recordings::SessionReader expert = opened("a.ctpm", start);
  EXPECT_TRUE(compare::check_same_scene(expert, opened("b.ctpm", other_look)));
  const auto reason = [&](const std::string& name, const recordings::SessionStart& trainee) {
    const auto same = compare::check_same_scene(expert, opened(name, trainee));
    return same ? std::string() : same.errors()[0].message;
  };
  EXPECT_NE(reason("c.ctpm", softer).find("differs in axial.k"), std::string::npos);
  EXPECT_NE(reason("d.ctpm", larger).find("36 spheres instead of 27"), std::string::npos);
  EXPECT_NE(reason("e.ctpm", other_tool).find("its tools are fist"), std::string::npos);
  // One of the two is from before that setting.
  recordings::SessionStart less_exact = start;
  less_exact.model.solver.velocity_enough = 2e-6;
  EXPECT_EQ(reason("g.ctpm", less_exact), "");
  EXPECT_EQ(compare::scene_hash(less_exact.model), compare::scene_hash(start.model));
  EXPECT_NE(compare::scene_hash(softer.model), compare::scene_hash(start.model));
  EXPECT_NE(reason("f.ctpm", testing::small_start(3, 3, 3, 2)).find("2 hands instead of 1"), std::string::npos);
}

TEST(Track, FindsTheElementsThatWereSeveredAndWhen) {
  const testing::Folder folder;
  const recordings::SessionStart start = testing::small_start();
  const testing::Lived lived = testing::record_session(folder / "a.ctpm", start, 700, 250);
  auto reader = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto track = compare::read_track(*reader);
  ASSERT_TRUE(track) << testing::text_of(track.errors());
  EXPECT_TRUE(track->replays);
  ASSERT_EQ(track->strokes.size(), 2u);  // the ball, then the scalpel
  EXPECT_EQ(track->strokes[1], (compare::Spell{400, 700}));
  std::vector<std::int64_t> severed_in(700);
  for (const std::int64_t tick : track->severed_at)
    if (tick >= 0) ++severed_in[std::size_t(tick)];
  std::int64_t all = 0;
  for (std::size_t i = 0; i < lived.records.size(); ++i) {
    EXPECT_EQ(severed_in[i], lived.records[i].severed) << i;
    all += severed_in[i];
  }
  EXPECT_GT(all, 5);
}

/// A press, a cut in ticks [400, 700), and another press from there on. The record of one tick states another hash than
/// a replay has.
compare::SessionTrack track_of_end(const std::string& path, std::int64_t ticks, std::int64_t forged,
                                   compare::Replaying replaying) {
  const recordings::SessionStart start = testing::small_start();
  auto writer = recordings::SessionWriter::create(path, start, {.wait_when_full = true, .keyframe_ticks = 500});
  CTPM_CHECK(bool(writer), "a test's session can be created");
  testing::live(start, ticks, [&](const State& after, recordings::TickRecord record) {
    if (after.tick == forged + 1) ++record.state_hash;
    writer->append(after, record);
  });
  CTPM_CHECK(bool(writer->finish()), "a test's session can be finished");
  auto reader = recordings::SessionReader::open(path);
  return *compare::read_track(*reader, replaying);
}

TEST(Track, OfWhatIsCutInTheEndReplaysNoMoreThanCuts) {
  const testing::Folder folder;
  using compare::Replaying;
  // Cut before the last keyframe, after it, and to the very end.
  for (const std::int64_t ticks : {1050, 900, 690}) {
    const std::string name = std::to_string(ticks);
    const auto all = track_of_end(folder / (name + "a.ctpm"), ticks, -1, Replaying::all),
               ends = track_of_end(folder / (name + "b.ctpm"), ticks, ticks - 1, Replaying::ends);
    ASSERT_TRUE(all.cut && ends.cut) << ticks;
    EXPECT_GT(ends.cut->area, 1e-6);
    EXPECT_EQ(all.cut->area, ends.cut->area) << ticks;
    EXPECT_EQ(all.cut->depth, ends.cut->depth) << ticks;
    for (std::size_t i = 0; i < all.severed_at.size(); ++i)
      EXPECT_EQ(all.severed_at[i] >= 0, ends.severed_at[i] >= 0) << ticks;
    EXPECT_EQ(ends.replays, ticks != 690) << "the last tick is one of the cut's, or is not replayed";
  }
  EXPECT_FALSE(track_of_end(folder / "in.ctpm", 900, 650, Replaying::ends).replays);
}

/// A session of two hands, in the other order if `is_swapped`.
compare::SessionTrack track_of_two(const std::string& path, bool is_swapped) {
  const recordings::SessionStart start = testing::small_start(3, 3, 3, 2);
  auto writer = recordings::SessionWriter::create(path, start, {.wait_when_full = true});
  CTPM_CHECK(bool(writer), "a test's session can be created");
  State state = start.initial_state;
  stepping::Stepper stepper(start.model);
  for (std::int64_t tick = 0; tick < 700; ++tick) {
    Inputs inputs = testing::scripted_inputs(tick, start.model.rest_position.z.back(), 2);
    if (is_swapped) {
      const Hand first = inputs;
      static_cast<Hand&>(inputs) = inputs.second, inputs.second = first;
    }
    const stepping::StepReport report = stepper.step(state, inputs);
    writer->append(state, recordings::make_record(inputs, report, 1e-4, recordings::state_hash(state)));
  }
  CTPM_CHECK(bool(writer->finish()), "a test's session can be finished");
  auto reader = recordings::SessionReader::open(path);
  return *compare::read_track(*reader);
}

TEST(Track, IsThatOfTheHandThatCuts) {
  const testing::Folder folder;
  const compare::SessionTrack right = track_of_two(folder / "right.ctpm", false),
                              left = track_of_two(folder / "left.ctpm", true);
  EXPECT_EQ(right.hand, 0u);
  EXPECT_EQ(left.hand, 1u);
  EXPECT_TRUE(right.is_verified && left.is_verified);
  EXPECT_EQ(right.tool, left.tool);
  EXPECT_EQ(right.tip, left.tip);
  ASSERT_EQ(left.other_force.size(), 700u);
  const auto peak = [](const std::vector<double>& force) { return *std::max_element(force.begin(), force.end()); };
  EXPECT_GT(peak(left.other_force), 0.01);
  EXPECT_NEAR(peak(left.force), peak(right.force), 1e-3 * peak(right.force));
  const compare::Comparison comparison = compare::compare_sessions(right, left, testing::small_start(3, 3, 3, 2));
  const auto other = std::find_if(comparison.values.begin(), comparison.values.end(), [](const auto& value) {
    return value.measure->key == std::string("other_hand_peak_force_n");
  });
  ASSERT_NE(other, comparison.values.end());
  EXPECT_EQ(other->trainee, peak(left.other_force));
}

}  // namespace
}  // namespace ctpm
