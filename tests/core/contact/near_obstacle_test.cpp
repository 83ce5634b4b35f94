// What NearObstacle finds in each tick is every vertex inside the obstacle, of the organ's own surface and of cuts.

#include "core/contact/near_obstacle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "core/contact/moved.h"
#include "tests/core/contact/swing.h"

namespace ctpm {
namespace {

using contact::NearObstacle;
using testing::kTop;

constexpr Vec3 kMiddle{0, 0, 0.5 * kTop};  // of the block [m]

/// A vertex that is inside: the block of the grid that its patch is in (-1: it is of the whole surface), the piece, the
/// vertex, and how deep it is [m].
using Seen = std::tuple<std::int32_t, std::int32_t, std::int32_t, double>;

std::vector<Seen> found(NearObstacle& near, const Vec3Array& position) {
  std::vector<Seen> seen;
  for (const NearObstacle::Found& f : near.find(position)) {
    const cutbody::CutPatch* patch = near.parts()[std::size_t(f.part)].patch;
    seen.emplace_back(patch == nullptr ? -1 : patch->block, patch == nullptr ? -1 : patch->piece, f.vertex,
                      f.inside.depth);
  }
  return seen;
}

/// All vertices that are inside, in the order in which NearSurface::near() and CutPatches::near() visit them.
std::vector<Seen> all_inside(surface::Body& body, contact::CutSurfaces& cuts, const surface::ObstacleShape& shape) {
  std::vector<Seen> seen;
  const Box everywhere(Vec3{-1, -1, -1}, Vec3{1, 1, 1});
  const auto add = [&](surface::Body& part, const cutbody::CutPatch* patch) {
    std::vector<char> was(part.surface.vertex_count(), 0);
    part.surface.near(everywhere, [&](const surface::NearSurface::Triangle& t, const Vec3* corners) {
      for (int c = 0; c < 3; ++c) {
        if (std::exchange(was[std::size_t(t.corner[c])], 1) || (patch == nullptr && cuts.hides(t.corner[c]))) continue;
        const double depth = shape.inside(corners[c]).depth;
        if (depth > 0)
          seen.emplace_back(patch == nullptr ? -1 : patch->block, patch == nullptr ? -1 : patch->piece, t.corner[c],
                            depth);
      }
    });
  };
  add(body, nullptr);
  cuts.near(0, everywhere, [&](cutbody::CutPatch& patch) { add(patch.body, &patch); });
  return seen;
}

/// `turn`: by how much the block turns over in a tick [rad]. `moves`: which spheres do, by their places at rest; all if
/// it is empty.
void expect_all_found(Model model, const Obstacle& obstacle, State first, double turn = 0,
                      const std::function<bool(Vec3)>& moves = {}) {
  model.obstacles = {obstacle};
  contact::CutSurfaces cuts(model);
  std::vector<surface::Body> bodies = surface::bodies_of(model), others = surface::bodies_of(model);
  const surface::ObstacleShape shape(obstacle);
  NearObstacle near(model, bodies[0], shape, cuts);
  State state = std::move(first);
  const Vec3Array rest = state.position;
  std::size_t most = 0, fewest = 1000;
  for (int tick = 0; tick < 600; ++tick) {
    testing::swing(rest, tick, state.position);
    // The block bounces on the obstacle, and once it jumps.
    const double up = 0.004 * std::abs(std::sin(0.013 * tick)) + (tick > 500 && tick < 520 ? 0.03 : 0);
    const Quat over{std::cos(0.5 * turn * tick), std::sin(0.5 * turn * tick), 0, 0};
    for (std::size_t i = 0; i < rest.size(); ++i)
      if (!moves || moves(rest[i]))
        state.position.set(i, kMiddle + rotate(over, state.position[i] - kMiddle) + Vec3{0, 0, up - 0.001});
      else
        state.position.set(i, rest[i] - Vec3{0, 0, 0.001});
    cuts.begin_tick(state, false), cuts.begin(state.position);
    bodies[0].surface.begin(state.position), others[0].surface.begin(state.position);
    (void)cuts.wait_near(Box(Vec3{-1, -1, -1}, Vec3{1, 1, 1}), state, bodies[0].surface);
    if (tick == 250) {  // a step that is refused
      Vec3Array lost = state.position;
      lost.set(lost.size() / 2, {NAN, NAN, NAN});
      bodies[0].surface.begin(lost), cuts.begin(lost);
      (void)near.find(lost);
      bodies[0].surface.begin(state.position), cuts.begin(state.position);
    }
    const std::vector<Seen> seen = found(near, state.position);
    ASSERT_EQ(seen, all_inside(others[0], cuts, shape)) << "tick " << tick;
    most = std::max(most, seen.size()), fewest = std::min(fewest, seen.size());
  }
  EXPECT_GT(most, 40u);
  EXPECT_EQ(fewest, 0u);
}

/// Two cuts across the block, with a strip of a seventh of a spacing between them.
State thin_strip(const Model& model) {
  State state = testing::half_cut(model, 0.012);
  testing::cut_along(
      model,
      [](double t) {
        const double y = -0.06 + 0.12 * t;
        return testing::straight_front({0.0017, y, 0.012}, {0.0017, y, 0.06});
      },
      state);
  return state;
}

Model block() { return testing::block_to_cut(6, 6, 4, 0.008); }

/// `gap`: between it and the block at rest [m].
Obstacle above(ObstacleKind kind, Vec3 half = {}, double gap = 0) {
  return {"above", kind, {0, 0, kTop + gap + half.z}, {0, 1, 0, 0}, half};  // upside down: it fills what is above
}

TEST(FarthestMoved, IsInfinitelyFarWhereAnyPlaceIsNotFinite) {
  Vec3Array before(3), now(5);
  now.set(3, {0, 3, 4});
  EXPECT_DOUBLE_EQ(contact::farthest_moved(before, 0, 3, now, 2, {}), 5);
  for (const double bad : {double(NAN), double(INFINITY)}) {
    now.set(2, {bad, 0, 0});
    EXPECT_EQ(contact::farthest_moved(before, 0, 3, now, 2, {}), INFINITY) << "wherever it is";
  }
}

TEST(NearObstacle, FindsEachVertexThatIsInsideAPlaneWhileTissueMoves) {
  const Model model = block();
  expect_all_found(model, above(ObstacleKind::plane), rest_state(model));
}

TEST(NearObstacle, FindsThoseOfACutInsideAPlane) {
  const Model model = block();
  expect_all_found(model, above(ObstacleKind::plane), testing::half_cut(model, 0.012));
}

TEST(NearObstacle, FindsThoseOfACutInsideABox) {
  const Model model = block();
  expect_all_found(model, above(ObstacleKind::box, {0.02, 0.03, 0.01}), testing::half_cut(model, 0.012));
}

TEST(NearObstacle, FindsThoseOfAThinStripThatTurnsOver) {
  const Model model = block();
  expect_all_found(model, above(ObstacleKind::plane), thin_strip(model), 0.01);
}

TEST(NearObstacle, FindsThoseOfAThinStripThatTurnsSlowlyIntoAPlane) {
  Model model = block();
  model.obstacles = {above(ObstacleKind::plane, {}, 0.001)};
  contact::CutSurfaces cuts(model);
  std::vector<surface::Body> bodies = surface::bodies_of(model), others = surface::bodies_of(model);
  const surface::ObstacleShape shape(model.obstacles[0]);
  NearObstacle near(model, bodies[0], shape, cuts);
  State state = thin_strip(model);
  const Vec3Array rest = state.position;
  std::size_t first = 0, last = 0;
  for (int tick = 0; tick <= 4000; ++tick) {
    const double half = 0.5 * 5e-5 * tick;
    const Quat over{std::cos(half), std::sin(half), 0, 0};
    for (std::size_t i = 0; i < rest.size(); ++i) state.position.set(i, kMiddle + rotate(over, rest[i] - kMiddle));
    cuts.begin_tick(state, false), cuts.begin(state.position);
    bodies[0].surface.begin(state.position), others[0].surface.begin(state.position);
    (void)cuts.wait_near(Box(Vec3{-1, -1, -1}, Vec3{1, 1, 1}), state, bodies[0].surface);
    const std::vector<Seen> seen = found(near, state.position);
    if (tick % 10 != 0) continue;
    ASSERT_EQ(seen, all_inside(others[0], cuts, shape)) << "tick " << tick;
    if (tick == 0) first = seen.size();
    last = seen.size();
  }
  EXPECT_EQ(first, 0u);
  EXPECT_GT(last, 40u);
}

TEST(NearSurface, AnOffsetMovesNoFartherThanItsBound) {
  Model model = block();
  model.obstacles = {above(ObstacleKind::plane)};
  State state = thin_strip(model);
  contact::CutSurfaces cuts(model);
  cuts.begin_tick(state, false), cuts.begin(state.position);
  std::vector<surface::Body> bodies = surface::bodies_of(model);
  bodies[0].surface.begin(state.position);
  const Box everywhere(Vec3{-1, -1, -1}, Vec3{1, 1, 1});
  (void)cuts.wait_near(everywhere, state, bodies[0].surface);
  std::mt19937 bits(1);
  std::uniform_real_distribution<double> number(-1, 1);
  int bounded = 0;
  double most = 0;
  cuts.near(0, everywhere, [&](cutbody::CutPatch& patch) {
    surface::NearSurface& surface = patch.body.surface;
    for (std::int32_t vertex = 0; vertex < std::int32_t(surface.vertex_count()); vertex += 7) {
      surface.begin(state.position);
      if (!(surface.offset_size(vertex) > 0)) continue;
      const surface::TurnBound bound = surface.offset_bound(vertex);
      const Vec3 before = surface.offset(vertex);
      const double reach = std::min(bound.reach, 1e-3);
      bounded += bound.rate > 0 && bound.reach > 0;
      // Spheres that move each on its own, or about the vertex.
      const Vec3 at = surface.place(vertex), turn{number(bits), number(bits), number(bits)};
      Vec3Array moves(state.position.size());
      double most_moved = 0;
      for (std::size_t i = 0; i < moves.size(); ++i) {
        const Vec3 own{number(bits), number(bits), number(bits)}, arm = state.position[i] - at;
        const Vec3 about = norm(arm) < 0.012 ? cross(turn, arm) : Vec3{};
        moves.set(i, vertex % 2 == 0 ? own : about);
        most_moved = std::max(most_moved, norm(moves[i]));
      }
      Vec3Array moved = state.position;
      for (std::size_t i = 0; i < moved.size(); ++i) moved.set(i, moved[i] + reach / most_moved * moves[i]);
      surface.begin(moved);
      const double by = norm(surface.offset(vertex) - before);
      ASSERT_LE(by, bound.rate * reach + 1e-12) << vertex;
      if (bound.rate > 0) most = std::max(most, by / (bound.rate * reach));
    }
  });
  EXPECT_GT(bounded, 20);
  EXPECT_GT(most, 0.02) << "it says something";
}

TEST(NearObstacle, FindsThoseOfAPartThatMovesWhileAllElseRests) {
  const Model model = block();
  const auto is_at_end = [](Vec3 rest) { return rest.x > 0.02; };
  for (const ObstacleKind kind : {ObstacleKind::plane, ObstacleKind::box})
    expect_all_found(model, above(kind, {0.02, 0.03, 0.01}), testing::half_cut(model, 0.012), 0, is_at_end);
}

TEST(NearObstacle, FindsThoseOfALongThinStripWhoseFarEndMoves) {
  const Model model = testing::block_to_cut(4, 20, 4, 0.008);
  constexpr double kEnd = 0.066;
  const State state = testing::long_strip(model, kEnd);
  expect_all_found(model, above(ObstacleKind::plane, {}, 0.02), state, 0,
                   [&](Vec3 rest) { return rest.y > kEnd - 0.016; });
}

}  // namespace
}  // namespace ctpm
