// What NearTriangles keeps from tick to tick is all that one look at the present tick finds, in the same order.

#include "core/contact/near_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/core/contact/swing.h"

namespace ctpm {
namespace {

using contact::BallPart, contact::NearTriangles, contact::Reach;
using testing::kTop;

constexpr double kRadius = 0.008, kMargin = 0.3 * kRadius;  // [m]

/// A triangle: the block of the grid that its patch is in (-1: it is of the whole surface), the piece, and its corners.
using Seen = std::array<std::int32_t, 5>;

/// Whether the reach has one of four points of a triangle.
template <class Place>
bool has_any(const Reach& reach, Place&& place) {
  const Vec3 a = place(0), b = place(1), c = place(2);
  return reach.meets(Box(a)) || reach.meets(Box(b)) || reach.meets(Box(c)) || reach.meets(Box((a + b + c) / 3));
}

std::vector<Seen> touching(const NearTriangles& near, const Reach& reach) {
  std::vector<Seen> seen;
  for (const NearTriangles::Found& found : near.triangles()) {
    const BallPart& of = near.parts()[std::size_t(found.part)];
    const surface::NearSurface::Triangle* triangle = found.triangle;
    const auto place = [&](int c) { return of.surface->place(triangle->corner[c]); };
    for (int c = 0; c < 3; ++c) EXPECT_GE(norm(place(c) - reach.centre), near.least_apart(found));
    if (!has_any(reach, place)) continue;
    const bool is_whole = of.patch == nullptr;
    seen.push_back({is_whole ? -1 : of.patch->block, is_whole ? -1 : of.patch->piece, triangle->corner[0],
                    triangle->corner[1], triangle->corner[2]});
  }
  return seen;
}

/// Where the ball is in a tick.
Reach ball_at(int tick) {
  const double phase = 0.05 * tick;
  const bool jumps = tick % 97 == 96;
  Reach reach({0.02 * std::sin(0.6 * phase) + (jumps ? 0.01 : 0.0), 0.02 * std::cos(0.41 * phase), kTop}, kRadius);
  // What was touched before reaches farther, and comes and goes at once.
  if (tick % 31 < 15) reach.distance = std::max(reach.distance, reach.add(reach.centre + Vec3{0.011, 0, -0.004}));
  return reach;
}

/// The last tick in which the tissue moved: for a third of the time it stands still while the ball moves on.
int last_move(int tick) { return std::min(tick, tick - tick % 300 + 199); }

void expect_nothing_left_out(const Model& model, State state, bool is_cut) {
  contact::CutSurfaces cuts(model);
  cuts.prepare();
  surface::NearSurface kept(model, 0, 1), anew(model, 0, 1);
  surface::Gathering gathering;
  gathering.add(model.surfaces[0], 0.001);
  const auto slots = std::int32_t(model.surfaces[0].vertex.size());
  NearTriangles near({{0, 0, &kept, &gathering}}, slots, cuts, 0);
  const Vec3Array rest = state.position;
  std::size_t most_patches = 0, most_seen = 0, far = 0;
  for (int tick = 0; tick < 1200; ++tick) {
    const Reach reach = ball_at(tick);
    testing::swing(rest, last_move(tick), state.position);
    cuts.begin_tick(state, false), cuts.begin(state.position);
    kept.begin(state.position), anew.begin(state.position);
    (void)cuts.wait_near(reach.box, state, kept);
    if (tick == 250) {  // a step that is refused
      Vec3Array lost = state.position;
      lost.set(lost.size() / 2, {NAN, NAN, NAN});
      kept.begin(lost), cuts.begin(lost);
      near.find(reach, kMargin, lost);
      kept.begin(state.position), cuts.begin(state.position);
    }
    near.find(reach, kMargin, state.position);
    const std::vector<Seen> seen = touching(near, reach);
    for (const NearTriangles::Found& found : near.triangles()) far += near.least_apart(found) > kRadius;
    most_patches = std::max(most_patches, near.parts().size() - 1), most_seen = std::max(most_seen, seen.size());
    NearTriangles once({{0, 0, &anew, &gathering}}, slots, cuts, 0);
    once.find(reach, 0, state.position);
    ASSERT_EQ(seen, touching(once, reach)) << "tick " << tick;
    std::size_t own = 0;
    for (const auto& t : model.surfaces[0].triangle) {
      const auto place = [&](std::size_t c) { return anew.place(t[c]); };
      own += has_any(reach, place);
    }
    ASSERT_EQ(std::count_if(seen.begin(), seen.end(), [](const Seen& s) { return s[0] < 0; }), std::ptrdiff_t(own));
  }
  EXPECT_GT(most_seen, 50u);
  EXPECT_GT(far, 1000u) << "triangles that are known not to be in the ball";
  EXPECT_EQ(most_patches > 0, is_cut);
}

TEST(NearTriangles, LeaveOutNothingThatABallMayTouchWhileItMoves) {
  const Model model = testing::block_to_cut(6, 6, 4, kRadius);
  expect_nothing_left_out(model, rest_state(model), false);
}

TEST(NearTriangles, LeaveOutNothingOfACutThatABallMayTouchWhileItMoves) {
  const Model model = testing::block_to_cut(6, 6, 4, kRadius);
  expect_nothing_left_out(model, testing::half_cut(model, 0.012), true);
}

}  // namespace
}  // namespace ctpm
