// A session in which a pin pulls a sphere through its neighbours and lets go: its events, and what info and the overlay
// of a video say.

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "recordings/session_reader.h"
#include "studio/film/session_film.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using recordings::EventKind;
using testing::run_ctpm;

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr const char* kScene = R"({
  "format": "ctpm-scene", "version": 1, "name": "block", "gravity_m_per_s2": [0, 0, 0], "settle_s": 0,
  "organs": [{ "name": "block", "rig": { "block": [3, 3, 3] }, "material": { "preset": "liver" },
               "anchors": [{ "lowest_mm": 1 }], "inversion_resistance": 10 }],
  "tools": [{ "name": "pin", "kind": "pin", "holds_mm": [0, 0, 24] }] })";
constexpr const char* kScript = R"({
  "format": "ctpm-script", "version": 1, "steps": [
    { "take": { "tool": "pin", "at_mm": [0, 0, 24] } },
    { "move": { "to_mm": [0, 0, -6], "speed_mm_per_s": 100 } },
    { "wait_s": 0.1 }, { "put_away": true }, { "wait_s": 1 }] })";

TEST(InsideOut, IsToldByEventsInfoAndTheOverlayUntilTheTissueComesBack) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "block.json") << kScene;
  std::ofstream(folder.path() / "script.json") << kScript;
  const auto recorded =
      run_ctpm({"record", "block.json", "--script", "script.json", "-o", "a.ctpm", "--fast"}, folder.path());
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  auto reader = recordings::SessionReader::open((folder.path() / "a.ctpm").string());
  ASSERT_TRUE(reader);
  const auto events = reader->events();
  ASSERT_TRUE(events);
  std::vector<recordings::Event> turns;
  for (const recordings::Event& event : *events)
    if (event.kind == EventKind::turned_inside_out || event.kind == EventKind::came_back) turns.push_back(event);
  ASSERT_EQ(turns.size(), 2u);
  EXPECT_EQ(turns[0].kind, EventKind::turned_inside_out);
  EXPECT_EQ(turns[1].kind, EventKind::came_back);
  EXPECT_GE(turns[1].cells, turns[0].cells);
  const std::int64_t turned = turns[0].tick, back = turns[1].tick;
  ASSERT_LT(turned, back);

  const auto film = film::SessionFilm::create(*reader, {0, reader->tick_count()}, false);
  ASSERT_TRUE(film);
  const auto look = [&](std::int64_t tick) {
    const auto shot = (*film)->shoot(tick);
    EXPECT_TRUE(shot);
    return shot->overlay;
  };
  const render::OverlayData before = look(turned), during = look(turned + 1), last = look(back), after = look(back + 1);
  EXPECT_EQ(before.verdict_tone, render::VerdictTone::good);
  EXPECT_EQ(during.inside_out, turns[0].cells);
  for (const render::OverlayData& bad : {during, last}) {
    EXPECT_GT(bad.inside_out, 0);
    EXPECT_EQ(bad.verdict_tone, render::VerdictTone::bad);
    EXPECT_TRUE(holds(bad.verdict, "INSIDE OUT")) << bad.verdict;
  }
  EXPECT_EQ(after.inside_out, 0);
  EXPECT_EQ(after.verdict_tone, render::VerdictTone::good);
  EXPECT_EQ(after.verdict, before.verdict);
  // A film that begins in between says so in its first picture.
  const auto late = film::SessionFilm::create(*reader, {turned + 3, reader->tick_count()}, false);
  ASSERT_TRUE(late);
  const auto first = (*late)->shoot(turned + 3);
  ASSERT_TRUE(first);
  EXPECT_GT(first->overlay.inside_out, 0);
  EXPECT_EQ(first->overlay.verdict_tone, render::VerdictTone::bad);

  const auto info = run_ctpm({"info", "a.ctpm"}, folder.path());
  EXPECT_TRUE(holds(info.out, "turned inside out: tissue turned inside out")) << info.out;
  EXPECT_TRUE(holds(info.out, "inside out no tissue at the end")) << info.out;
  EXPECT_TRUE(holds(run_ctpm({"info", "a.ctpm", "--json"}, folder.path()).out, "\"ends_inside_out\": false"));

  // A session that ends while the pin holds the sphere.
  const auto cut_short = run_ctpm({"record", "block.json", "--script", "script.json", "-o", "b.ctpm", "--fast",
                                   "--duration-s", std::to_string(double(back - 20) / 1000)},
                                  folder.path());
  ASSERT_EQ(cut_short.code, 0) << cut_short.err;
  const auto info_of_b = run_ctpm({"info", "b.ctpm"}, folder.path());
  EXPECT_TRUE(holds(info_of_b.out, "inside out TISSUE IS INSIDE OUT at the end")) << info_of_b.out;
  EXPECT_TRUE(holds(run_ctpm({"info", "b.ctpm", "--json"}, folder.path()).out, "\"ends_inside_out\": true"));
}

}  // namespace
}  // namespace ctpm
