// Real time that a session loses on a late machine is kept in it, and whoever measures time says so.

#include <algorithm>
#include <chrono>
#include <thread>

#include "studio/compare/slip.h"
#include "studio/session/run_session.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using namespace ctpm::testing;

constexpr std::int64_t kTicks = 400, kLateTick = 50;

/// A hand over the block; in one tick it keeps the loop waiting for 0.3 s.
class LateSource : public sources::InputSource {
 public:
  explicit LateSource(double top) : top_(top) {}
  std::optional<Inputs> next(std::int64_t tick, const stepping::StepReport&) override {
    if (tick == kLateTick) std::this_thread::sleep_for(std::chrono::milliseconds(300));
    if (tick >= kTicks) return std::nullopt;
    return scripted_inputs(tick, top_);
  }

 private:
  double top_;
};

compare::SessionTrack track_of(const std::string& path) {
  auto reader = recordings::SessionReader::open(path);
  CTPM_CHECK(bool(reader), "a test's session opens");
  auto track = compare::read_track(*reader);
  CTPM_CHECK(bool(track), "a test's session can be measured");
  return *track;
}

class Clock : public ::testing::Test {
 protected:
  /// Records a session of a hand, or of a `source`, in real time.
  session::RunOutcome record(const std::string& name, const std::string& source) {
    recordings::SessionStart start = small_start(3, 2, 2);
    start.metadata["source"] = source;
    auto writer = recordings::SessionWriter::create(folder_ / name, start);
    CTPM_CHECK(bool(writer), "a test's session can be created");
    LateSource late(start.model.rest_position.z.back());
    State state = start.initial_state;
    const session::RunOutcome outcome = session::run_session(start.model, state, late, *writer, {});
    CTPM_CHECK(bool(writer->finish()), "a test's session can be finished");
    return outcome;
  }
  Folder folder_;
};

TEST_F(Clock, WhatALateTickLosesBeyondATenthOfASecondIsKeptPerMomentAndPerSession) {
  const session::RunOutcome outcome = record("a.ctpm", "igtl");
  EXPECT_EQ(outcome.ticks, kTicks);
  EXPECT_GE(outcome.slip, 0.19) << "0.3 s, less what the ticks behind it make up for";
  EXPECT_GE(outcome.late_ticks, 1);
  auto reader = recordings::SessionReader::open(folder_ / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto records = reader->ticks(0, kTicks);
  ASSERT_TRUE(records);
  EXPECT_GE((*records)[kLateTick].slip, 0.299);
  for (std::size_t i = kLateTick; i < records->size(); ++i) EXPECT_GE((*records)[i].slip, 0.19) << i;
  EXPECT_LT(records->back().slip, (*records)[kLateTick].slip) << "ticks catch up within bounds";
  const auto statistics = reader->statistics();
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->slip, records->back().slip);
  EXPECT_GE(statistics->slip_max, 0.299);
  EXPECT_TRUE(reader->check_all()) << "and they are counted anew when it is verified";
}

TEST_F(Clock, ALateTickSaysThatItsInputCameLate) {
  const session::RunOutcome outcome = record("a.ctpm", "igtl");
  auto reader = recordings::SessionReader::open(folder_ / "a.ctpm");
  ASSERT_TRUE(reader);
  const auto events = reader->events();
  ASSERT_TRUE(events);
  const auto late = std::ranges::find_if(*events, [](const recordings::Event& event) {
    return event.kind == recordings::EventKind::late_tick && event.tick == kLateTick;
  });
  ASSERT_NE(late, events->end());
  EXPECT_GE(late->parts.input, 0.299);
  const double tick = reader->start().model.tick;
  EXPECT_EQ(recordings::late_cause(late->parts, tick), recordings::LateCause::input);
  EXPECT_GT(late->parts.solver, 0);
  // What is late is what the tick itself took too long, and the delay before it.
  EXPECT_LE(late->parts.sum() - tick, late->late + 1e-3);
  EXPECT_EQ(session::late_ticks_of(*events, tick), outcome.late_by);
  EXPECT_EQ(outcome.late_by.total(), outcome.late_ticks);
  EXPECT_NE(outcome.late_by.text().find("input "), std::string::npos) << outcome.late_by.text();
}

TEST_F(Clock, AComparisonGivesNoMeasureOfTimeWhereAHandLostIt) {
  record("hand.ctpm", "igtl"), record("script.ctpm", "script");
  const compare::SessionTrack hand = track_of(folder_ / "hand.ctpm"), script = track_of(folder_ / "script.ctpm");
  EXPECT_FALSE(hand.is_timed);
  EXPECT_TRUE(script.is_timed) << "a script moves by ticks, not by the clock";
  EXPECT_TRUE(hand.is_verified);
  const recordings::SessionStart scene = small_start(3, 2, 2);
  for (const auto& [a, b, is_lost] : {std::tuple{&script, &hand, true}, {&script, &script, false}}) {
    compare::Comparison comparison = compare::compare_sessions(*a, *b, scene);
    compare::refuse_times(comparison, *a, *b);
    int times = 0, others = 0;
    for (const compare::MeasuredValue& value : comparison.values) {
      const std::string key = value.measure->key;
      const bool is_time = key.ends_with("_s") || key == "spectral_arc_length" || key == "log_dimensionless_jerk";
      if (!value.trainee) continue;
      ++(is_time ? times : others);
    }
    EXPECT_EQ(times > 0, !is_lost);
    EXPECT_GT(others, 3);
    if (!is_lost) continue;
    const auto completion = std::ranges::find_if(
        comparison.values, [](const auto& value) { return std::string(value.measure->key) == "completion_time_s"; });
    EXPECT_NE(completion->note.find("the trainee's session lacks"), std::string::npos) << completion->note;
  }
}

/// Forces have no hash of their own: a forged one is told by the replay.
TEST_F(Clock, AComparisonTakesForcesFromAReplayThatVerified) {
  const recordings::SessionStart start = small_start(3, 2, 2);
  double peak = 0;
  auto writer = recordings::SessionWriter::create(folder_ / "forged.ctpm", start, {.wait_when_full = true});
  ASSERT_TRUE(writer);
  live(start, 300, [&](const State& after, recordings::TickRecord record) {
    peak = std::max(peak, norm(record.tool_force));
    record.tool_force = 0.3 * record.tool_force;
    writer->append(after, record);
  });
  ASSERT_TRUE(writer->finish());
  ASSERT_GT(peak, 0.01);
  auto reader = recordings::SessionReader::open(folder_ / "forged.ctpm");
  ASSERT_TRUE(reader);
  const auto replayed = compare::read_track(*reader), believed = compare::read_track(*reader, compare::Replaying::none);
  ASSERT_TRUE(replayed && believed);
  EXPECT_TRUE(replayed->is_verified);
  EXPECT_FALSE(believed->is_verified);
  EXPECT_EQ(*std::ranges::max_element(replayed->force), peak);
  EXPECT_NEAR(*std::ranges::max_element(believed->force), 0.3 * peak, 1e-12);
}

}  // namespace
}  // namespace ctpm
