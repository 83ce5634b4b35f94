// The expert's cut on the trainee's organ, and what the trainee cut elsewhere, in films of a pair.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "recordings/replay.h"
#include "studio/compare/session_track.h"
#include "studio/film/expert_cut_of.h"
#include "studio/render/frame.h"
#include "studio/session/cut_at_end.h"
#include "tests/studio/commands/run_program.h"

namespace ctpm {
namespace {

using testing::run_ctpm;

const std::string kShipped = std::string(CTPM_SOURCE_DIR) + "/recordings/shipped/";
const std::string kExpert = kShipped + "kidney-cut-expert.ctpm", kClumsy = kShipped + "kidney-cut-clumsy.ctpm",
                  kPress = kShipped + "liver-press-expert.ctpm";

recordings::SessionReader open(const std::string& path) { return *recordings::SessionReader::open(path); }

TEST(ExpertLine, StraysAreTheElementsThatACompareCounts) {
  recordings::SessionReader expert = open(kExpert), clumsy = open(kClumsy);
  const auto cut = film::expert_cut_of(expert);
  ASSERT_TRUE(cut);
  const auto by_expert = compare::read_track(expert, compare::Replaying::none),
             by_clumsy = compare::read_track(clumsy, compare::Replaying::none);
  ASSERT_TRUE(by_expert && by_clumsy);
  const Model& model = clumsy.start().model;
  std::size_t last = 0;
  const auto keyframes = clumsy.keyframe_ticks();
  ASSERT_TRUE(keyframes);
  ASSERT_GT(keyframes->size(), 4u);
  for (const std::int64_t tick : *keyframes) {
    const auto keyframe = clumsy.keyframe_at_or_before(tick);
    ASSERT_TRUE(keyframe);
    std::size_t counted = 0, others = 0;
    for (std::size_t e = 0; e < by_clumsy->severed_at.size(); ++e) {
      const std::int64_t at = by_clumsy->severed_at[e];
      const bool is_stray = at >= 0 && at < tick && by_expert->severed_at[e] < 0;
      (e < compare::ElementPlaces(model).constraints ? counted : others) += is_stray;
    }
    const std::size_t strays = render::strays_of(model, **cut, keyframe->state).size();
    EXPECT_EQ(strays, counted) << tick;
    // A constraint is severed with an element of its line: where none is marked, none is counted.
    if (strays == 0) {
      EXPECT_EQ(others, 0u) << tick;
    }
    EXPECT_GE(strays, last);
    last = strays;
  }
  EXPECT_GT(last, 5u);
  EXPECT_TRUE(render::strays_of(model, **cut, clumsy.start().initial_state).empty());
  EXPECT_TRUE(render::strays_of(model, **cut, session::cut_at_end(expert)->state).empty());
  // The line is as long as the cut along the kidney's skin.
  double length = 0;
  for (const render::ExpertCut::Piece& piece : (*cut)->line()) length += norm(piece.to - piece.from);
  EXPECT_NEAR(length, by_expert->cut->length, 0.1 * by_expert->cut->length);
}

TEST(ExpertLine, TheCutAtTheEndIsTheReplayedOne) {
  for (const std::string& path : {kExpert, kClumsy, kPress}) {
    recordings::SessionReader session = open(path);
    const auto end = session::cut_at_end(session);
    ASSERT_TRUE(end) << path;
    EXPECT_TRUE(end->is_same);
    auto cursor = recordings::ReplayCursor::create(session);
    ASSERT_TRUE(cursor && cursor->seek(session.tick_count()));
    EXPECT_TRUE(end->state.swept == cursor->state().swept && end->state.axial_severed == cursor->state().axial_severed);
  }
}

class ExpertLineFilm : public ::testing::Test {
 protected:
  render::Frame film(const std::string& name, std::vector<std::string> command) {
    command.insert(command.begin(), "export");
    command.insert(command.end(), {"-o", name + "/", "--fps", "10", "--from-s", "3.9", "--to-s", "4", "--size",
                                   "640x360", "--align", "clock"});
    const auto made = run_ctpm(command, folder_.path());
    EXPECT_EQ(made.code, 0) << made.err;
    const auto frame = render::read_png((folder_.path() / name / "000001.png").string());
    EXPECT_TRUE(frame) << name << made.out;
    return frame ? *frame : render::Frame{};
  }
  /// Pixels between two columns that differ.
  static int differing(const render::Frame& a, const render::Frame& b, int from, int to) {
    int count = 0;
    for (int y = 0; y < a.height && b.height == a.height; ++y)
      for (int x = from; x < to; ++x) {
        const auto i = std::size_t(y * a.width + x) * 3;
        count += a.rgb[i] != b.rgb[i] || a.rgb[i + 1] != b.rgb[i + 1] || a.rgb[i + 2] != b.rgb[i + 2];
      }
    return count;
  }
  static int strays_in(const render::Frame& frame) {
    int count = 0;
    for (std::size_t i = 0; i < frame.rgb.size(); i += 3) {
      double off = 0;
      for (std::size_t c = 0; c < 3; ++c)
        off = std::max(off, std::abs(frame.rgb[i + c] - 255 * render::kStrayColour[c]));
      count += off < 6;
    }
    return count;
  }
  const testing::TemporaryFolder folder_;
};

TEST_F(ExpertLineFilm, ItIsOnTheTraineesHalfUnlessItIsNotWanted) {
  const std::vector<std::string> pair{kExpert, "--beside", kClumsy, "--overlay", "none"};
  std::vector<std::string> without = pair;
  without.push_back("--no-expert-line");
  const render::Frame shown = film("line", pair), plain = film("plain", without);
  EXPECT_EQ(differing(shown, plain, 0, 320), 0) << "the expert's half";
  EXPECT_GT(differing(shown, plain, 320, 640), 200);
  EXPECT_LT(differing(shown, plain, 320, 640), 320 * 360 / 10);
  const auto ghost = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {kClumsy, "--ghost", kExpert, "--overlay", "none"});
    return film(name, more);
  };
  EXPECT_GT(differing(ghost("ghost", {}), ghost("ghost-plain", {"--no-expert-line"}), 0, 640), 200);
  // Sessions of two scenes have none.
  EXPECT_EQ(strays_in(film("other", {kPress, "--beside", kClumsy, "--overlay", "none"})), 0);
  EXPECT_GT(strays_in(shown), 20);
}

}  // namespace
}  // namespace ctpm
