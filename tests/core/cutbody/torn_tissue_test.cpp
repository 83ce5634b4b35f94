// Where cuts sever all elements between two parts, the tissue that they leave between them tears: what nothing holds
// together does not stretch.

#include <cmath>
#include <functional>
#include <vector>

#include "core/cutbody/cut_grid.h"
#include "core/cutbody/cut_mesh.h"
#include "core/cutting/pieces.h"
#include "tests/core/cut_blocks.h"
#include "tests/core/topology.h"

namespace ctpm {
namespace {

/// An upright cut across x = 1.3 mm, between the spheres at -6 and 6 mm. Elements cross it at y = 1.3 and 6 mm, and
/// nowhere between.
constexpr double kX = 0.0013;
std::function<cutting::Front(double)> stroke(double from, double to, double low = -0.01, double high = 0.05) {
  return [=](double t) {
    const double y = from + t * (to - from);
    return testing::straight_front({kX, y, low}, {kX, y, high});
  };
}
constexpr double kLeft = -0.06, kRight = 0.06;  // beyond the block
constexpr double kHole = 0.0015, kHoleEnd = 0.0058;

/// How the spheres of both sides move [m].
const Vec3 kToLeft{-0.02, 0, 0.01}, kToRight{0.05, 0.01, 0};

/// Every vertex above a height moves with one side or the other.
void expect_two_sides(const testing::DrawnCut& drawn, double above) {
  int with_left = 0, with_right = 0;
  for (std::size_t v = 0; v < drawn.vertex.size(); ++v) {
    if (drawn.surface.vertex[v].z < above) continue;
    const Vec3 by = drawn.vertex[v] - drawn.surface.vertex[v];
    const bool is_left = norm(by - kToLeft) < 1e-9, is_right = norm(by - kToRight) < 1e-9;
    EXPECT_TRUE(is_left || is_right) << drawn.surface.vertex[v].x << " " << drawn.surface.vertex[v].y;
    with_left += is_left, with_right += is_right;
  }
  EXPECT_GT(with_left, 100);
  EXPECT_GT(with_right, 100);
}

TEST(TornTissue, ABridgeWithoutElementsTears) {
  const Model model = testing::block_to_cut(8, 8, 4, 0.01);
  State state = rest_state(model);
  testing::cut_along(model, stroke(kLeft, kHole), state);
  testing::cut_along(model, stroke(kRight, kHoleEnd), state);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    state.position.add(i, model.rest_position[i].x < 0 ? kToLeft : kToRight);
  const testing::DrawnCut drawn(model, state);
  EXPECT_EQ(drawn.pieces, 2);
  cutbody::CutGrid grid(model, 0);
  (void)grid.update(state);
  const cutbody::CutMesh mesh = cutbody::make_mesh(grid);
  EXPECT_EQ(testing::open_edges(mesh.triangle), 0);
  EXPECT_EQ(testing::components(mesh.triangle), 2);
  expect_two_sides(drawn, -1);
}

TEST(TornTissue, ABridgeWithoutElementsTearsWhereTheTissueIsJoinedFarFromIt) {
  // Only the lowest layer of spheres is not cut.
  const Model model = testing::block_to_cut(8, 8, 8, 0.01);
  State state = rest_state(model);
  constexpr double kLow = 0.006, kHigh = 0.1, kTop = 0.06;
  testing::cut_along(model, stroke(kLeft, kHole, kLow, kHigh), state);
  testing::cut_along(model, stroke(kRight, kHoleEnd, kLow, kHigh), state);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.rest_position[i].z > kLow) state.position.add(i, model.rest_position[i].x < 0 ? kToLeft : kToRight);
  const testing::DrawnCut drawn(model, state);
  EXPECT_EQ(drawn.pieces, 1);
  expect_two_sides(drawn, kTop);
}

TEST(TornTissue, IsAFunctionOfTheSweptSurfaceAlone) {
  // What is touched is made of the swept surface, without the elements that a State holds as severed.
  const Model model = testing::block_to_cut(8, 8, 4, 0.01);
  State state = rest_state(model), swept;
  testing::cut_along(model, stroke(kLeft, kHole), state);
  testing::cut_along(model, stroke(kRight, kHoleEnd), state);
  swept.swept = state.swept, swept.swept_organ = state.swept_organ;
  cutbody::CutBody of_state(model, 0), of_swept(model, 0);
  (void)of_state.update(state), (void)of_swept.update(swept);
  EXPECT_EQ(of_swept.piece_count(), 2);
  EXPECT_EQ(of_swept.surface().triangle, of_state.surface().triangle);
  EXPECT_EQ(of_swept.surface().binding.weight, of_state.surface().binding.weight);
}

TEST(TornTissue, SpheresThatACutGoesThroughStayOnOneSideOfIt) {
  const Model model = testing::block_to_cut(7, 8, 4, 0.01);
  for (const bool is_forth : {true, false}) {
    State state = rest_state(model);
    testing::cut_along(
        model,
        [=](double t) {
          const double y = (is_forth ? 1 : -1) * (kLeft + t * (kRight - kLeft));
          return testing::straight_front({0, y, -0.01}, {0, y, 0.05});
        },
        state);
    cutting::Pieces pieces(model);
    EXPECT_EQ(pieces.find(state), 2);
    EXPECT_EQ(testing::DrawnCut(model, state).pieces, 2);
  }
}

TEST(TornTissue, ABridgeWithElementsHolds) {
  const Model model = testing::block_to_cut(8, 8, 4, 0.01);
  State state = rest_state(model);
  testing::cut_along(model, stroke(kLeft, kHole), state);
  testing::cut_along(model, stroke(kRight, 0.0062), state);
  EXPECT_EQ(testing::DrawnCut(model, state).pieces, 1);
}

TEST(TornTissue, IsTheSameHoweverTheCutWasFollowed) {
  // The last row may still move: a tear that comes with it is taken back.
  const Model model = testing::block_to_cut(6, 6, 3, 0.01);
  State state = rest_state(model);
  cutbody::CutBody followed(model, 0);
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  std::vector<cutting::Crossing> crossings;
  for (const auto& way : {stroke(kLeft, kHole), stroke(kRight, kHoleEnd), stroke(kHoleEnd, kHole - 0.001)})
    for (int i = 0; i < 60; ++i) {
      const cutting::Front from = way(i / 60.0), to = way((i + 1) / 60.0);
      (void)testing::sever(model, from, to, state, crossings);
      cutting::add_swept(state, from, to, newly);
      (void)followed.update(state);
      if (i % 6 != 5) continue;
      cutbody::CutBody anew(model, 0);
      (void)anew.update(state);
      ASSERT_EQ(anew.piece_count(), followed.piece_count()) << i;
      ASSERT_EQ(anew.surface().triangle, followed.surface().triangle) << i;
      ASSERT_EQ(anew.surface().binding.weight, followed.surface().binding.weight) << i;
      for (std::size_t v = 0; v < anew.surface().vertex.size(); ++v)
        ASSERT_EQ(norm(anew.surface().vertex[v] - followed.surface().vertex[v]), 0) << i;
    }
  EXPECT_EQ(followed.piece_count(), 2);
}

}  // namespace
}  // namespace ctpm
