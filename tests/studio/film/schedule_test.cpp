#include "studio/film/schedule.h"

#include <gtest/gtest.h>

#include <cmath>

#include "studio/compare/matched_moments.h"
#include "studio/film/captions.h"

namespace ctpm {
namespace {

recordings::SessionReader shipped(const std::string& name) {
  auto reader = recordings::SessionReader::open(std::string(CTPM_SOURCE_DIR) + "/recordings/shipped/" + name);
  EXPECT_TRUE(reader) << name;
  return *std::move(reader);
}

class Schedule : public ::testing::Test {
 protected:
  static constexpr double kFrame = 1.0 / 30;
  recordings::SessionReader expert_ = shipped("kidney-cut-expert.ctpm"), clumsy_ = shipped("kidney-cut-clumsy.ctpm");

  std::vector<film::FrameTicks> by(const std::string& word, const session::TimeRange& range = {}) {
    auto matched = compare::match_sessions(expert_, clumsy_, word);
    EXPECT_TRUE(matched) << word;
    auto made = film::schedule({&expert_, &clumsy_}, {range, kFrame, *matched, {}});
    EXPECT_TRUE(made) << word;
    return *std::move(made);
  }
  static std::int64_t first(recordings::SessionReader& session, recordings::EventKind kind) {
    const auto events = session.events();
    for (const recordings::Event& event : *events)
      if (event.kind == kind) return event.tick;
    return -1;
  }
};

TEST_F(Schedule, ByTheClockBothAreAtOneTimeUntilOneEnds) {
  const auto ticks = by("clock");
  ASSERT_EQ(ticks.size(), 2u);
  EXPECT_EQ(ticks[0].frame_count, std::llround(std::ceil(double(clumsy_.tick_count()) / 1000 * 30)));
  for (std::int64_t frame = 0; frame < ticks[0].ended - 1; ++frame)
    EXPECT_EQ(ticks[0].tick(frame), ticks[1].tick(frame));
  EXPECT_EQ(ticks[0].tick(ticks[0].ended), expert_.tick_count());
}

TEST_F(Schedule, WhatHappensIsSeenTogether) {
  for (const auto& [word, kind] :
       {std::pair{"contact", recordings::EventKind::contact_begins}, std::pair{"cut", recordings::EventKind::cut}}) {
    const auto ticks = by(word);
    std::int64_t frame = 0;
    while (ticks[0].tick(frame) < first(expert_, kind)) ++frame;
    EXPECT_NEAR(double(ticks[1].tick(frame)), double(first(clumsy_, kind)), 1000 * kFrame + 1) << word;
  }
}

TEST_F(Schedule, ByHandTheOneThatIsOverFirstSaysSo) {
  for (const char* word : {"2", "-2"}) {
    const auto ticks = by(word);
    std::size_t over = 0;
    for (std::size_t half = 0; half < 2; ++half) {
      const std::int64_t ended = ticks[half].ended, all = (half ? clumsy_ : expert_).tick_count();
      EXPECT_EQ(ticks[half].tick(ended - 1), all) << word;
      EXPECT_LT(ticks[half].tick(ended - 2), all) << word;
      over += ended < ticks[half].frame_count;
    }
    EXPECT_EQ(over, 1u) << word;
  }
  for (const film::FrameTicks& ticks : by("path")) EXPECT_EQ(ticks.ended, ticks.frame_count);
}

TEST_F(Schedule, ByHandTheOneThatBeginsLaterSaysSoUntilThen) {
  for (const auto& [word, late] : {std::pair{"2", 0u}, {"-2", 1u}}) {
    const auto ticks = by(word);
    EXPECT_NEAR(double(ticks[late].begun) * kFrame, 2, kFrame) << word;
    EXPECT_EQ(ticks[late].tick(ticks[late].begun - 1), 0) << word;
    EXPECT_GT(ticks[late].tick(ticks[late].begun), 0) << word;
    EXPECT_EQ(ticks[1 - late].begun, 0) << word;
    EXPECT_EQ(by(word, {.from_s = 2.5, .to_s = {}})[late].begun, 0) << "a part in which both go on";
  }
  for (const char* word : {"path", "contact", "clock"})
    for (const film::FrameTicks& ticks : by(word)) EXPECT_EQ(ticks.begun, 0) << word;
}

TEST_F(Schedule, NothingIsLeftOutNothingIsHurriedAndNoHalfStandsStillForLong) {
  for (const char* word : {"path", "contact", "cut", ""}) {
    const auto ticks = by(word);
    for (std::size_t half = 0; half < 2; ++half) {
      const std::int64_t frames = ticks[half].frame_count;
      EXPECT_EQ(ticks[half].tick(frames - 1), (half ? clumsy_ : expert_).tick_count()) << word;
      std::int64_t before = 0, still = 0;
      for (std::int64_t frame = 0; frame < frames; ++frame) {
        const std::int64_t now = ticks[half].tick(frame), passed = now - before;
        EXPECT_GE(passed, 0);
        EXPECT_LE(double(passed), 1000 * kFrame + 1.001) << word << " " << frame;
        EXPECT_GE(ticks[half].share(frame), 0);
        EXPECT_LE(ticks[half].share(frame), 1 + 1e-9);
        still += passed == 0;
        before = now;
      }
      EXPECT_LT(double(still), 0.25 * double(frames)) << word;
    }
  }
}

TEST_F(Schedule, AlongThePathTheToolsAreNearEachOther) {
  const auto ticks = by("path"), clock = by("clock");
  const auto apart = [&](const std::vector<film::FrameTicks>& shown) {
    const auto a = expert_.ticks(0, expert_.tick_count()), b = clumsy_.ticks(0, clumsy_.tick_count());
    double sum = 0;
    for (std::int64_t frame = 0; frame < shown[0].frame_count; ++frame) {
      const auto at = [&](const auto& records, std::int64_t tick) {
        return (*records)[std::size_t(std::max<std::int64_t>(tick - 1, 0))].inputs.position;
      };
      sum += norm(at(a, shown[0].tick(frame)) - at(b, shown[1].tick(frame)));
    }
    return sum / double(shown[0].frame_count);
  };
  EXPECT_LT(apart(ticks), 0.8 * apart(clock));
}

TEST_F(Schedule, AlongThePathNoHalfCrawlsWhileTheOtherGoesOn) {
  const auto ticks = by("path");
  // Before and after the tools are held only one of them may have something to show.
  const auto held = [](recordings::SessionReader& session) {
    const auto records = session.ticks(0, session.tick_count());
    std::int64_t first = -1, last = 0;
    for (std::size_t i = 0; i < records->size(); ++i)
      if ((*records)[i].inputs.tool >= 0) first = first < 0 ? std::int64_t(i) : first, last = std::int64_t(i);
    return std::pair{first, last};
  };
  const auto [from, to] = held(expert_);
  const auto [clumsy_from, clumsy_to] = held(clumsy_);
  const double least = compare::least_pace(double(to - from), double(clumsy_to - clumsy_from));
  EXPECT_GT(least, 0.1);
  int seen = 0;
  for (std::int64_t frame = 0; frame < ticks[0].frame_count; ++frame) {
    const std::int64_t a = ticks[0].tick(frame), b = ticks[1].tick(frame);
    if (a <= from || a >= to || b <= clumsy_from || b >= clumsy_to) continue;
    for (const film::FrameTicks& half : ticks) EXPECT_GE(half.share(frame), least - 1e-9) << frame;
    EXPECT_NEAR(std::max(ticks[0].share(frame), ticks[1].share(frame)), 1, 1e-9) << frame;
    ++seen;
  }
  EXPECT_GT(seen, 200);
}

TEST_F(Schedule, SlowPartsTakeFourTimesAsLongAndNothingElseDoes) {
  const auto all = film::all_moments(expert_, {0, expert_.tick_count()});
  ASSERT_TRUE(all);
  const auto slow = film::slow_parts(*all, "cut,worst", 1e-3);
  ASSERT_TRUE(slow);
  ASSERT_EQ(slow->size(), 2u) << "the cut begins, and later the force is largest";
  const auto ticks = film::schedule({&expert_}, {{}, kFrame, {}, *slow});
  ASSERT_TRUE(ticks);
  const film::FrameTicks& shown = ticks->front();
  const double whole = double(expert_.tick_count()) * 1e-3, slowed = 2 * 0.75;
  EXPECT_NEAR(double(shown.frame_count) * kFrame, whole + (film::kSlower - 1) * slowed, 2 * kFrame);
  EXPECT_EQ(shown.tick(shown.frame_count - 1), expert_.tick_count());
  for (std::int64_t frame = 1; frame + 1 < shown.frame_count; ++frame) {
    const double at = double(shown.tick(frame)) * 1e-3, passed = double(shown.tick(frame) - shown.tick(frame - 1));
    bool is_slow = false, is_edge = false;
    for (const auto& [from, to] : *slow) {
      is_slow |= at > from && at <= to;
      for (const double edge : {from, to}) is_edge |= std::abs(at - edge) < 1.1 * kFrame;
    }
    if (is_edge) continue;
    EXPECT_NEAR(passed, 1000 * kFrame / (is_slow ? film::kSlower : 1), 1.01) << at;
  }
  for (const auto& [from, to] : *slow) EXPECT_NEAR(to - from, 0.75, 1e-9);
  EXPECT_NEAR((*slow)[0][0] + 0.25, double(first(expert_, recordings::EventKind::cut)) * 1e-3, 1e-9);
  EXPECT_FALSE(film::slow_parts(*all, "cut,all", 1e-3));
  EXPECT_EQ(film::slow_parts(*all, "damage", 1e-3)->size(), 0u);
}

TEST_F(Schedule, APartIsThatOfTheFirstSession) {
  const auto whole = by("cut"), part = by("cut", {.from_s = 2, .to_s = 3});
  EXPECT_EQ(part[0].range.from, 2000);
  EXPECT_NEAR(double(part[0].tick(part[0].frame_count - 1)), 3000, 1);
  std::int64_t frame = 0;
  while (whole[0].tick(frame) < 2000) ++frame;
  EXPECT_NEAR(double(part[1].range.from), double(whole[1].tick(frame)), 1000 * kFrame + 1);
}

TEST_F(Schedule, AMomentIsThatOfTheFilm) {
  for (const char* word : {"clock", "contact", "cut", "path", "2", "-2"}) {
    const auto film = by(word);
    const auto matched = compare::match_sessions(expert_, clumsy_, word);
    ASSERT_TRUE(matched) << word;
    const auto moment_at = [&](std::int64_t tick) {
      return film::schedule_moment({&expert_, &clumsy_}, double(tick) * expert_.start().model.tick, *matched);
    };
    int seen = 0;
    for (std::int64_t frame = 1; frame + 1 < film[0].frame_count; frame += 7) {
      const std::int64_t there = film[0].tick(frame);
      if (film[0].tick(frame - 1) == there || film[0].tick(frame + 1) == there) continue;  // it stands still
      const auto moment = moment_at(there);
      ASSERT_TRUE(moment) << word << " " << there;
      for (const film::FrameTicks& of : *moment) EXPECT_EQ(of.frame_count, 1);
      EXPECT_EQ((*moment)[0].tick(0), there) << word;
      // For one tick of a session that is slowed down, there are several of the other.
      const double most = 1 + std::max(1.0, film[1].share(frame)) / film[0].share(frame);
      EXPECT_NEAR(double((*moment)[1].tick(0)), double(film[1].tick(frame)), most) << word << " " << there;
      EXPECT_EQ((*moment)[1].begun == 0, frame >= film[1].begun) << word << " " << there;
      EXPECT_EQ((*moment)[1].ended == 0, frame >= film[1].ended) << word << " " << there;
      ++seen;
    }
    EXPECT_GT(seen, 5) << word;
    EXPECT_EQ((*moment_at(0))[0].tick(0), 0) << word;
    EXPECT_EQ((*moment_at(0))[0].begun == 0, film[0].begun == 0) << word << ": its start is not before it";
    EXPECT_EQ((*moment_at(expert_.tick_count()))[0].tick(0), expert_.tick_count()) << word;
    EXPECT_FALSE(moment_at(expert_.tick_count() + 1)) << word;
    EXPECT_FALSE(moment_at(-1)) << word;
  }
}

}  // namespace
}  // namespace ctpm
