#include "studio/film/captions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <tuple>

#include "studio/compare/session_track.h"
#include "tests/recordings/sessions.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using Kind = film::Moment::Kind;

TEST(Captions, WordsAreShownAfterTheirMomentUntilOthersFollow) {
  const std::vector<film::Moment> moments{
      {0, "title", Kind::title}, {1000, "one", Kind::cut}, {1800, "two", Kind::cut}};
  EXPECT_EQ(film::words_at(moments, 0, 2000), "");
  EXPECT_EQ(film::words_at(moments, 1, 2000), "title");
  EXPECT_EQ(film::words_at(moments, 1000, 2000), "title") << "the State before the tick is shown";
  EXPECT_EQ(film::words_at(moments, 1001, 2000), "one");
  EXPECT_EQ(film::words_at(moments, 1001, 500), "one");
  EXPECT_EQ(film::words_at(moments, 1501, 500), "");
  EXPECT_EQ(film::words_at(moments, 3800, 2000), "two");
  EXPECT_EQ(film::words_at(moments, 3801, 2000), "");
  EXPECT_EQ(film::words_at({}, 5, 2000), "");
}

TEST(Captions, ThoseOfAContactGoSoonAfterItButCanBeRead) {
  const std::int64_t shown = 2500;
  const std::vector<film::Moment> long_one{{1000, "touches", Kind::contact, {}, 2600}};
  EXPECT_EQ(film::words_at(long_one, 3100, shown), "touches") << "half a second longer than the contact";
  EXPECT_EQ(film::words_at(long_one, 3101, shown), "");
  const std::vector<film::Moment> short_one{{1000, "touches", Kind::contact, {}, 1010}};
  EXPECT_EQ(film::words_at(short_one, 2200, shown), "touches") << "1.2 s, to be read";
  EXPECT_EQ(film::words_at(short_one, 2201, shown), "");
  const std::vector<film::Moment> lasting{{1000, "touches", Kind::contact, {}, 9000}, {5000, "cuts", Kind::cut}};
  EXPECT_EQ(film::words_at(lasting, 3500, shown), "touches");
  EXPECT_EQ(film::words_at(lasting, 3501, shown), "") << "not longer than before";
  // At half the speed everything takes half as many ticks.
  EXPECT_EQ(film::words_at(short_one, 1600, shown / 2), "touches");
  EXPECT_EQ(film::words_at(short_one, 1601, shown / 2), "");
  // A page of stills tells what has happened since the one before, whatever is true by then.
  EXPECT_EQ(film::words_between(short_one, 999, 4000), "touches");
  EXPECT_EQ(film::words_between(short_one, 1000, 4000), "");
  EXPECT_EQ(film::words_between(short_one, 0, 1000), "");
}

TEST(Captions, AMomentKnowsWhenItsToolLeaves) {
  const testing::Folder folder;
  const recordings::SessionStart start = testing::small_start();
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {});
  ASSERT_TRUE(writer);
  using enum recordings::EventKind;
  for (const auto& [tick, kind, tool] :
       std::vector<std::tuple<int, recordings::EventKind, int>>{{10, contact_begins, 0},
                                                                {12, contact_begins, 1},
                                                                {20, cut, 1},
                                                                {30, contact_ends, 0},
                                                                {40, contact_begins, 0},
                                                                {50, contact_ends, 1}})
    writer->event({.tick = tick, .kind = kind, .tool = tool});
  testing::live(start, 60,
                [&](const State& after, const recordings::TickRecord& record) { writer->append(after, record); });
  ASSERT_TRUE(writer->finish({}));
  auto session = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(session);
  const auto moments = film::all_moments(*session, {0, 60});
  ASSERT_TRUE(moments);
  std::vector<std::pair<std::int64_t, std::int64_t>> told;
  for (const film::Moment& m : *moments)
    if (m.kind == Kind::contact || m.kind == Kind::cut) told.emplace_back(m.tick, m.left);
  using Told = decltype(told);
  EXPECT_EQ(told, (Told{{10, 30}, {12, 50}, {20, 50}, {40, film::Moment::kNever}}));
}

TEST(Captions, APartBeginsWithTheTitleAndTellsOnlyOfWhatHappensInIt) {
  const std::vector<film::Moment> told =
      film::told_moments({{693, "touches", Kind::contact}, {4332, "cuts", Kind::cut}}, "title", 1e-3, 3000);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(film::words_at(told, 3001, 2500), "title") << "the touch was before";
  EXPECT_EQ(film::words_at(told, 4400, 2500), "cuts");
}

TEST(Captions, OfTwoThatAreNearTheGraverIsToldAndBothOfTheLargest) {
  const auto told = [](const std::vector<film::Moment>& all) {
    std::vector<std::string> texts;
    for (const film::Moment& moment : film::told_moments(all, "title", 1e-3, 0)) texts.push_back(moment.text);
    return texts;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(told({{900, "strong", Kind::force, "4 N"}, {1200, "deep", Kind::deepest, "9 mm"}}),
            (Texts{"title", "largest: 4 N, 9 mm"}));
  EXPECT_EQ(told({{900, "deep", Kind::deepest}, {1200, "harm", Kind::damage}}), (Texts{"title", "harm"}));
  EXPECT_EQ(told({{900, "touch", Kind::contact}, {1200, "cut", Kind::cut}, {1300, "strong", Kind::force}}),
            (Texts{"title", "cut"}));
  EXPECT_EQ(told({{900, "strong", Kind::force, "4 N"}, {1700, "deep", Kind::deepest, "9 mm"}}),
            (Texts{"title", "strong", "deep"}));
}

TEST(Captions, TrackAndPictureSayTheSameInEveryFrame) {
  const std::vector<film::Moment> moments{{0, "title", Kind::title},
                                          {333, "one", Kind::contact, {}, 600},
                                          {1500, "two", Kind::cut},
                                          {9999, "beyond", Kind::cut}};
  // Slow in the middle, as where two sessions are matched.
  film::FrameTicks ticks{{0, 2000}, 90, 0, 90, {}, {}};
  ticks.tick = [](std::int64_t frame) {
    return frame < 20   ? 33 * frame
           : frame < 60 ? 660 + 5 * (frame - 20)
                        : std::min<std::int64_t>(860 + 38 * (frame - 60), 2000);
  };
  constexpr double kFps = 30;
  for (const std::int64_t shown : {300, 5000}) {
    const std::vector<video::Caption> captions = film::captions_of(moments, ticks, shown, kFps);
    EXPECT_EQ(captions.size(), 3u);
    for (std::int64_t frame = 0; frame < ticks.frame_count; ++frame) {
      std::string said;
      for (const video::Caption& caption : captions)
        if ((double(frame) + 0.5) / kFps > caption.from_s && (double(frame) + 0.5) / kFps < caption.to_s)
          said += caption.text;
      EXPECT_EQ(said, film::words_at(moments, ticks.tick(frame), shown)) << frame;
    }
  }
}

// A damaged file may name a tool that the scene does not have; reading past the scene's tools ended the program.
TEST(Captions, ATickWithAToolThatDoesNotExistIsNoCut) {
  const testing::Folder folder;
  const recordings::SessionStart start = testing::small_start();
  auto writer = recordings::SessionWriter::create(folder / "a.ctpm", start, {});
  ASSERT_TRUE(writer);
  testing::live(start, 300, [&](const State& after, recordings::TickRecord record) {
    if (after.tick == 40) record.inputs.tool = 1'000'000, record.depth = 1;
    if (after.tick == 41) record.inputs.tool = -1'000'000;
    writer->append(after, record);
  });
  ASSERT_TRUE(writer->finish({}));
  auto session = recordings::SessionReader::open(folder / "a.ctpm");
  ASSERT_TRUE(session);
  const auto moments = film::all_moments(*session, {0, 300});
  ASSERT_TRUE(moments);
  EXPECT_TRUE(std::ranges::any_of(*moments, [](const film::Moment& m) { return m.kind == Kind::deepest; }));
  const auto track = compare::read_recorded(*session);
  ASSERT_TRUE(track);
  EXPECT_EQ(track->tool[39], 1'000'000);
}

TEST(Captions, ThoseOfAPairSayOfWhichHalfTheyAre) {
  const std::vector<video::Caption> both =
      film::captions_of_pair({{0, 2, "begins"}, {5, 6, "cuts"}}, {{1, 3, "touches"}, {5, 6, "damage"}}, {"Ana", "Ben"});
  ASSERT_EQ(both.size(), 4u);
  const auto is = [&](std::size_t i, double from, double to, const char* text, bool is_chapter) {
    EXPECT_EQ(both[i].from_s, from) << i;
    EXPECT_EQ(both[i].to_s, to) << i;
    EXPECT_EQ(both[i].text, text) << i;
    EXPECT_EQ(both[i].is_chapter, is_chapter) << i;
  };
  is(0, 0, 1, "left (Ana): begins", true);
  is(1, 1, 2, "left (Ana): begins\nright (Ben): touches", true);
  is(2, 2, 3, "right (Ben): touches", false);
  is(3, 5, 6, "left (Ana): cuts\nright (Ben): damage", true);
}

TEST(Captions, AFileOfAnotherFormIsRefusedAndLeftAlone) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "a.mp4").string();
  for (const std::string& content :
       {std::string(), std::string("abc"), std::string(64, 'x'),
        std::string("\0\0\0\x10moov1234567", 16) + std::string("\0\0\0\x10mdat12345678", 16)}) {
    std::ofstream(path, std::ios::binary) << content;
    EXPECT_FALSE(video::add_captions(path, {{0, 1, "words"}}));
    EXPECT_EQ(testing::slurp(path), content);
    EXPECT_TRUE(video::add_captions(path, {})) << "nothing to add";
  }
}

}  // namespace
}  // namespace ctpm
