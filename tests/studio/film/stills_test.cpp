// Moments that stand alone: what lies between them is left out where a keyframe allows it, and nothing else changes.

#include <gtest/gtest.h>

#include <string>

#include "studio/film/session_film.h"
#include "tests/recordings/sessions.h"

namespace ctpm {
namespace {

using film::Between;
using film::SessionFilm;

constexpr std::int64_t kTicks = 1000, kForged = 600;
constexpr std::int32_t kKeyframes = 250;

/// A press and a cut. The record of tick kForged states another hash than a replay has, if `is_forged`.
recordings::SessionReader session(const std::string& path, bool is_forged) {
  recordings::SessionStart start = testing::small_start();
  start.scene_text = R"({"format": "ctpm-scene", "version": 1, "name": "block", "organs": [
    {"name": "block", "rig": {"block": [3, 3, 3]}, "material": {"preset": "liver"}, "anchors": [{"lowest_mm": 1}],
     "damage_force_n": 0.01}],
    "tools": [{"name": "ball", "kind": "ball", "radius_mm": 6}]})";
  auto writer = recordings::SessionWriter::create(path, start, {.wait_when_full = true, .keyframe_ticks = kKeyframes});
  CTPM_CHECK(bool(writer), "a test's session can be created");
  testing::live(start, kTicks, [&](const State& after, recordings::TickRecord record) {
    if (is_forged && after.tick == kForged + 1) ++record.state_hash;
    writer->append(after, record);
  });
  CTPM_CHECK(bool(writer->finish()), "a test's session can be finished");
  return *recordings::SessionReader::open(path);
}

std::unique_ptr<SessionFilm> film_of(recordings::SessionReader& reader, bool allow_diverged, Between between) {
  auto film = SessionFilm::create(reader, {0, 900}, allow_diverged, between);
  CTPM_CHECK(bool(film), "a test's session can be filmed");
  return std::move(*film);
}

TEST(Stills, AreThoseOfTheFilm) {
  const testing::Folder folder;
  recordings::SessionReader reader = session(folder / "a.ctpm", false);
  const auto all = film_of(reader, false, Between::replayed), alone = film_of(reader, false, Between::left_out);
  for (const std::int64_t tick : {300, 310, 500, 900}) {
    const auto a = all->shoot(tick), b = alone->shoot(tick);
    ASSERT_TRUE(a && b) << tick;
    EXPECT_EQ(recordings::state_hash(a->state), recordings::state_hash(b->state)) << tick;
    EXPECT_EQ(a->overlay.time, b->overlay.time);
    EXPECT_EQ(a->overlay.hand.force, b->overlay.hand.force);
    EXPECT_EQ(a->overlay.worst.force, b->overlay.worst.force) << tick;
    EXPECT_EQ(a->overlay.loose, b->overlay.loose);
    EXPECT_EQ(a->overlay.verdict, b->overlay.verdict);
    EXPECT_EQ(a->moments.size(), b->moments.size());
    ASSERT_EQ(a->overlay.history.size(), b->overlay.history.size()) << tick;
    for (std::size_t i = 0; i < a->overlay.history.size(); ++i)
      EXPECT_EQ(a->overlay.history[i].force, b->overlay.history[i].force) << tick;
  }
}

TEST(Stills, AreComparedSinceTheKeyframeBeforeThem) {
  const testing::Folder folder;
  recordings::SessionReader reader = session(folder / "a.ctpm", true);
  const auto all = film_of(reader, false, Between::replayed), alone = film_of(reader, false, Between::left_out);
  EXPECT_TRUE(all->shoot(300) && alone->shoot(300));
  EXPECT_FALSE(all->shoot(900)) << "a film goes through what differs";
  EXPECT_TRUE(alone->shoot(900)) << "it is of the keyframe at 750";
  const auto differs = film_of(reader, false, Between::left_out)->shoot(kForged + 1);
  ASSERT_FALSE(differs);
  EXPECT_NE(differs.errors()[0].message.find("differs from the recording since 0.600 s"), std::string::npos);
  const auto marked = film_of(reader, true, Between::left_out);
  EXPECT_EQ(marked->shoot(kForged)->overlay.verdict_tone, render::VerdictTone::good);
  EXPECT_EQ(marked->shoot(kForged + 1)->overlay.verdict_tone, render::VerdictTone::bad);
  EXPECT_EQ(film_of(reader, true, Between::replayed)->shoot(300)->overlay.verdict_tone, render::VerdictTone::bad);
}

}  // namespace
}  // namespace ctpm
