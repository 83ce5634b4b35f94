// What the server keeps in memory of a session.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "recordings/replay.h"
#include "recordings/state_hash.h"
#include "studio/server/cuts_ahead.h"
#include "studio/server/glimpse.h"
#include "studio/server/idle_pause.h"
#include "studio/server/moments.h"
#include "studio/server/spare_cursors.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm::server {
namespace {

const std::string kCut = std::string(CTPM_SHIPPED_SESSIONS) + "/kidney-cut-expert.ctpm";

/// Waits for a thread of low priority.
void wait_until(const std::function<bool()>& is_so) {
  while (!is_so()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

TEST(Moments, WhatIsKeptIsWhatTheReplayHasWithItsSweptSurface) {
  auto moments = Moments::open(kCut);
  ASSERT_TRUE(moments);
  auto reader = recordings::SessionReader::open(kCut);
  auto cursor = recordings::ReplayCursor::create(*reader);
  const std::vector<std::int64_t> keyframes = *reader->keyframe_ticks();
  std::size_t shared = 0;
  for (std::int64_t tick = 1000; tick + 10 < reader->tick_count(); tick += 10 * (*moments)->spacing()) {
    ASSERT_TRUE(cursor->seek(tick));
    (*moments)->keep(tick, cursor->state(), true);
    const Moments::Place place = (*moments)->before(tick + 10);
    ASSERT_EQ(place.first, tick);
    // Keyframes are read in the background.
    ASSERT_TRUE(place.second || std::binary_search(keyframes.begin(), keyframes.end(), tick));
    const Result<Moment> moment = (*moments)->read(place, *reader);
    ASSERT_TRUE(moment);
    EXPECT_EQ(moment->tick, tick);
    EXPECT_EQ(recordings::state_hash(moment->state), recordings::state_hash(cursor->state())) << "tick " << tick;
    if (!place.second) continue;
    EXPECT_EQ(place.second->swept_points(), cursor->state().swept.size());
    EXPECT_LE(place.second->state.swept.size(), kEdgeNodes) << "tick " << tick;
    shared += place.second->shared_points > 0;
  }
  EXPECT_GT(shared, 1u);
}

/// How far `moments` is from a kept State at the end of an interval that begins at `keyframe` [ticks].
std::int64_t longest_way(const Moments& moments, std::int64_t keyframe, std::int64_t end) {
  return end - std::max(keyframe, moments.before(end - 1).first);
}

TEST(Moments, TheLongestWaysAreHalvedFirstAndWhatIsFilledIsWhatAReplayFromTheKeyframeHas) {
  auto moments = Moments::open(kCut);
  ASSERT_TRUE(moments);
  auto reader = recordings::SessionReader::open(kCut);
  std::vector<std::int64_t> ends = *reader->keyframe_ticks();
  ends.push_back(reader->tick_count());
  ASSERT_GT(ends.size(), 5u);
  // The interval of aim() is whole by then, and half of each other one.
  wait_until([&] { return (*moments)->share() > 0.75; });
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    EXPECT_LE(longest_way(**moments, ends[i], ends[i + 1]), i == 0 ? Moments::kSpacing : 512) << "interval " << i;
  wait_until([&] { return (*moments)->share() >= 1; });
  auto cursor = recordings::ReplayCursor::create(*reader);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    ASSERT_TRUE(cursor->seek(ends[i]));
    for (std::int64_t tick = ends[i] + Moments::kSpacing; tick < ends[i + 1]; tick += Moments::kSpacing) {
      while (cursor->tick() < tick) ASSERT_TRUE(cursor->step());
      const Moments::Place place = (*moments)->before(tick);
      ASSERT_EQ(place.first, tick);
      ASSERT_TRUE(place.second);
      const Result<Moment> moment = (*moments)->read(place, *reader);
      ASSERT_TRUE(moment);
      EXPECT_TRUE(moment->is_same);
      ASSERT_EQ(recordings::state_hash(moment->state), recordings::state_hash(cursor->state())) << "tick " << tick;
    }
  }
}

TEST(Moments, NothingIsReplayedAheadWhileATrainingRunsOrSomebodyWaits) {
  auto pause = std::make_unique<IdlePause>();
  auto moments = Moments::open(kCut);
  ASSERT_TRUE(moments);
  const auto stays = [&](double share) {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    return (*moments)->share() == share;
  };
  EXPECT_TRUE(stays(0));
  (*moments)->rest(Moments::Rest::replaying);
  pause.reset();
  EXPECT_TRUE(stays(0));
  (*moments)->rest(Moments::Rest::none);
  wait_until([&] { return (*moments)->share() > 0; });
}

TEST(SpareCursors, OneIsReadyAtEachCutThatStaysAndGoesOnAsAnyOther) {
  const testing::TemporaryFolder folder;
  const std::string scenes = std::string(CTPM_SOURCE_DIR) + "/scenes/";
  const auto recorded = testing::run_ctpm(
      {"record", scenes + "kidney.json", "--script", scenes + "scripts/kidney-cut-x.json", "-o", "x.ctpm", "--fast"},
      folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  auto reader = recordings::SessionReader::open((folder.path() / "x.ctpm").string());
  ASSERT_TRUE(reader);
  SpareCursors spares(*reader);
  wait_until([&] { return spares.is_done(); });
  const std::size_t made = spares.count();
  EXPECT_GE(made, 2u);  // the first cut stays until the second one begins
  EXPECT_LE(made, SpareCursors::kMost);
  EXPECT_FALSE(spares.take(reader->start().initial_state));  // whole tissue has nothing to build
  const std::vector<std::int64_t> keyframes = *reader->keyframe_ticks();
  std::size_t taken = 0;
  for (const std::int64_t tick : keyframes) {
    const State state = reader->keyframe_at_or_before(tick)->state;
    std::optional<recordings::ReplayCursor> spare = spares.take(state);
    if (!spare) continue;
    ++taken;
    spare->resume(tick, state);
    for (int i = 0; i < 20 && spare->tick() < reader->tick_count(); ++i) ASSERT_TRUE(spare->step());
    EXPECT_TRUE(spare->same_so_far()) << "keyframe " << tick;
    EXPECT_FALSE(spares.take(state)) << "each is taken once";
  }
  EXPECT_EQ(taken, made);
}

TEST(CutsAhead, EveryKeyframesCutIsDrawnAndAGlimpseHasTheLargestPartOfItsOwn) {
  auto reader = recordings::SessionReader::open(kCut);
  const Model& model = reader->start().model;
  const auto cuts = std::make_shared<DrawnCuts>(model, 0);
  const std::size_t whole = cuts->nearest(reader->start().initial_state)->surfaces[0].triangle.size();
  const CutsAhead ahead(kCut, model, 0, cuts);
  const std::vector<std::int64_t> keyframes = *reader->keyframe_ticks();
  const State last = reader->keyframe_at_or_before(keyframes.back())->state;
  wait_until([&] { return cuts->of(last) != nullptr; });
  EXPECT_GT(cuts->of(last)->surfaces[0].triangle.size(), whole);
  std::size_t points = 0;
  int in_the_middle = 0;
  auto cursor = recordings::ReplayCursor::create(*reader);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const State state = reader->keyframe_at_or_before(keyframes[i])->state;
    const std::shared_ptr<const DrawnCut> drawn = cuts->of(state);
    ASSERT_TRUE(drawn) << "keyframe " << keyframes[i];
    EXPECT_EQ(drawn, cuts->nearest(state));
    points = std::max(points, drawn->key.points());
    // Later, in the middle of a cut that goes on to the next keyframe, there is nothing better yet.
    if (i + 1 == keyframes.size()) continue;
    const State next = reader->keyframe_at_or_before(keyframes[i + 1])->state;
    ASSERT_TRUE(cursor && cursor->seek((keyframes[i] + keyframes[i + 1]) / 2));
    const std::size_t now = cursor->state().swept.size();
    if (now == state.swept.size() || now == next.swept.size()) continue;
    EXPECT_EQ(cuts->of(cursor->state()), nullptr);
    EXPECT_EQ(cuts->nearest(cursor->state()), drawn);
    ++in_the_middle;
  }
  EXPECT_GT(in_the_middle, 3);
  EXPECT_EQ(points, last.swept.size());
}

}  // namespace
}  // namespace ctpm::server
