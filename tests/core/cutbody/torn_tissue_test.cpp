// Where cuts sever all elements between two parts, the tissue that they leave between them tears: what nothing holds
// together does not stretch.

#include <cmath>
#include <functional>
#include <map>
#include <random>
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

/// The pieces that a swept surface leaves of the network, of each sphere.
std::vector<std::int32_t> pieces_of_rows(const Model& model, const State& swept) {
  const cutting::RestMap map(model);
  const cutting::TissueDepth depth(model, map);
  const cutting::RestElements elements(model, depth);
  State state = rest_state(model);
  std::vector<cutting::Crossing> crossings;
  for (std::size_t row = 1; row < cutting::swept_rows(swept); ++row) {
    const auto [from, to, newly] = cutting::swept_row(swept, row);
    (void)cutting::sever_swept(model, elements, from, to, newly, state, crossings);
  }
  cutting::Pieces pieces(model);
  (void)pieces.find(state);
  return pieces.piece();
}

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

/// A row holds the front to some micrometres, so that it may miss an element that the front has severed.
TEST(TornTissue, ABridgeOfWhichTheStateHasSeveredTheElementsTears) {
  const Model model = testing::block_to_cut(8, 8, 4, 0.01);
  State state = rest_state(model);
  testing::cut_along(model, stroke(kLeft, kHole), state);
  testing::cut_along(model, stroke(kRight, kHole + 0.015), state);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    state.position.add(i, model.rest_position[i].x < kX ? kToLeft : kToRight);
  cutbody::CutBody body(model, 0);
  (void)body.update(state);
  EXPECT_EQ(body.piece_count(), 1) << "elements run in the bridge";
  int severed = 0;
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const auto is_left = [&](std::int32_t sphere) { return model.rest_position[std::size_t(sphere)].x < kX; };
    if (is_left(model.axial.a[e]) == is_left(model.axial.b[e]) || state.axial_severed[e] != 0) continue;
    state.axial_severed[e] = 1, ++severed;
  }
  EXPECT_GT(severed, 0);
  const testing::DrawnCut drawn(model, state);
  EXPECT_EQ(drawn.pieces, 2);
  expect_two_sides(drawn, -1);
  EXPECT_TRUE(body.update(state)) << "the rows are the same";
  EXPECT_EQ(body.piece_count(), 2);
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

TEST(TornTissue, NoTissueIsCarriedByTwoPieces) {
  // As lattices are, this one is a little larger than its organ: small tissue may have spheres outside only.
  FilledOrgan organ = testing::make_block(6, 6, 5);
  testing::add_faces(organ, 0.003);
  Vec3 middle;
  for (const Vec3& centre : organ.centre) middle += centre / double(organ.centre.size());
  for (Vec3& vertex : organ.surface.vertex) vertex = middle + 0.88 * (vertex - middle);
  surface::bind_surface(organ);
  network::OrganSettings settings;
  settings.name = "block", settings.material = testing::liver_material();
  Model model;
  ASSERT_TRUE(bool(network::add_organ(model, organ, settings)));
  model.tools = {testing::scalpel(0.1)};
  std::mt19937 random(5);
  const auto between = [&](double low, double high) { return low + (high - low) * double(random()) / 4294967296.0; };
  for (int trial = 0; trial < 25; ++trial) {
    State state = rest_state(model);
    for (int stroke = 0; stroke < 8; ++stroke) {
      const double angle = between(0, 6.28), off = between(-0.025, 0.025);
      const Vec3 way{std::cos(angle), std::sin(angle), 0}, tilt{between(-3, 3), between(-3, 3), 1};
      testing::cut_along(
          model,
          [=](double t) {
            const Vec3 at = middle + Vec3{-off * way.y, off * way.x, 0} + (0.12 * t - 0.06) * way;
            return testing::straight_front(at - 0.06 * tilt, at + 0.06 * tilt);
          },
          state);
    }
    const std::vector<std::int32_t> pieces = pieces_of_rows(model, state);
    cutbody::CutGrid grid(model, 0);
    (void)grid.update(state);
    std::map<std::int32_t, std::int32_t> piece;  // of the spheres of each node
    for (std::int32_t s = 0; s < grid.sphere_count(); ++s) {
      const std::int32_t node = grid.node_of_sphere(s), own = pieces[std::size_t(s)];
      if (node < 0) continue;
      EXPECT_EQ(piece.try_emplace(node, own).first->second, own) << "sphere " << s << " in trial " << trial;
    }
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
