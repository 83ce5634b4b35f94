// Meshes, rest states and counts on which the recipes stand.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "studio/fidelity/meshes.h"
#include "studio/fidelity/recipes.h"

namespace ctpm::fidelity {
namespace {

double volume_of(const importers::RawMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangle)
    volume += dot(mesh.vertex[std::size_t(a)], cross(mesh.vertex[std::size_t(b)], mesh.vertex[std::size_t(c)])) / 6;
  return volume;
}

TEST(Meshes, ABoxIsClosedOrientedOutwardsAndExact) {
  const importers::RawMesh box = box_mesh({-0.03, -0.02, 0}, {0.03, 0.02, 0.05}, 3e-3);
  const importers::MeshCounts counts = importers::count_mesh(box.vertex, box.triangle);
  EXPECT_EQ(counts.open_edges, 0);
  EXPECT_EQ(counts.non_manifold_edges, 0);
  EXPECT_EQ(counts.parts, 1);
  EXPECT_NEAR(volume_of(box), 0.06 * 0.04 * 0.05, 1e-15);
}

TEST(Meshes, ABoxEndsExactlyWhereItShould) {
  // 36 steps of 2 mm do not sum to 72 mm in binary.
  const importers::RawMesh box = box_mesh({-0.036, -0.036, -0.036}, {0.036, 0.036, 0.036}, 2e-3);
  for (const Vec3& v : box.vertex) EXPECT_LE(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}), 0.036);
  const Result<Body> body = make_body(block({72e-3, 72e-3, 48e-3}, 4e-3, Pace::slow, {}));
  ASSERT_TRUE(bool(body)) << to_string(body.errors()[0]);
  EXPECT_GE(body->model.sphere_count(), 6u * 6u * 4u) << "spacings along its edges";
}

TEST(Meshes, ABallIsClosedAndItsEdgesAreShort) {
  const importers::RawMesh ball = ball_mesh(40e-3, 2e-3);
  EXPECT_EQ(importers::count_mesh(ball.vertex, ball.triangle).open_edges, 0);
  EXPECT_NEAR(volume_of(ball) / (4 * std::numbers::pi / 3 * std::pow(40e-3, 3)), 1, 2e-3);
  for (const Vec3& v : ball.vertex) EXPECT_NEAR(norm(v), 40e-3, 1e-12);
  for (const auto& [a, b, c] : ball.triangle)
    EXPECT_LE(norm(ball.vertex[std::size_t(a)] - ball.vertex[std::size_t(b)]), 2e-3);
}

TEST(Distance, IsThatToTheNearestPointOfTheSurface) {
  Surface surface;
  const importers::RawMesh box = box_mesh({0, 0, 0}, {0.01, 0.02, 0.03}, 7e-3);
  surface.vertex = box.vertex, surface.triangle = box.triangle;
  EXPECT_NEAR(distance_to(surface, surface.vertex, {0.004, 0.011, 0.035}), 0.005, 1e-12) << "over a face";
  EXPECT_NEAR(distance_to(surface, surface.vertex, {0.013, 0.024, 0.015}), 0.005, 1e-12) << "beside an edge";
  EXPECT_NEAR(distance_to(surface, surface.vertex, {-0.002, -0.003, -0.006}), 0.007, 1e-12) << "off a corner";
  EXPECT_NEAR(distance_to(surface, surface.vertex, {0.003, 0.01, 0.015}), 0.003, 1e-12) << "inside";
}

TEST(Turns, AreTwelveRotationsThatTurnBack) {
  const std::vector<Quat> turns = twelve_turns();
  EXPECT_EQ(turns.size(), 12u);
  for (const Quat& turn : turns) {
    Body body;
    body.turn = turn, body.shift = {0.1, -0.2, 0.3};
    const Vec3 p{0.01, 0.02, -0.03};
    EXPECT_NEAR(norm(body.to_body(body.to_world(p)) - p), 0, 1e-15);
    EXPECT_EQ(std::count(turns.begin(), turns.end(), turn), 1);
  }
}

TEST(Cells, AreInsideOutWhereTheBodyIsMirrored) {
  const Result<Body> body = make_body(block({48e-3, 48e-3, 48e-3}, 4e-3, Pace::slow, {}));
  ASSERT_TRUE(bool(body)) << to_string(body.errors()[0]);
  State state = rest_state(body->model);
  const CellCount rest = count_cells(*body, state);
  EXPECT_GT(rest.cells, 0);
  EXPECT_EQ(rest.inside_out, 0);
  for (double& x : state.position.x) x = -x;
  EXPECT_EQ(count_cells(*body, state).inside_out, rest.cells);
}

TEST(Settle, EndsAtRestUnderGravity) {
  Specimen specimen = block({48e-3, 48e-3, 48e-3}, 4e-3, Pace::slow, {});
  specimen.gravity = {0, 0, -9.81};
  const Result<Body> body = make_body(specimen);
  ASSERT_TRUE(bool(body)) << to_string(body.errors()[0]);
  State state = rest_state(body->model);
  stepping::Stepper stepper(body->model);
  EXPECT_EQ(settle(stepper, state, {}).status, stepping::StepStatus::ok);
  const State rested = state;
  (void)stepper.step(state, {});
  for (std::size_t i = 0; i < state.position.size(); ++i)
    EXPECT_NEAR(norm(state.position[i] - rested.position[i]), 0, 1e-7);
}

TEST(Press, IsTheSameAQuarterTurnAround) {
  // A cubic lattice has this symmetry. The sides are not whole spacings, so rounding adds no layer of cells.
  const double depths[] = {2e-3, 4e-3};
  std::vector<double> forces[2];
  for (const int turned : {0, 1}) {
    Specimen specimen = block({76e-3, 76e-3, 50e-3}, 4e-3, Pace::slow, {20e-3});
    specimen.turn = turn_about({0, 0, 1}, turned * std::numbers::pi / 2);
    const Result<Body> body = make_body(specimen);
    ASSERT_TRUE(bool(body)) << to_string(body.errors()[0]);
    for (const PressPoint& point : press(*body, 0, {{0, 0, 50e-3}, {0, 0, -1}}, depths)) {
      EXPECT_TRUE(point.rests);
      forces[turned].push_back(point.force);
    }
  }
  EXPECT_GT(forces[0][1], forces[0][0]);
  EXPECT_GT(forces[0][0], 0);
  for (const std::size_t d : {0, 1}) EXPECT_NEAR(forces[1][d] / forces[0][d], 1, 1e-3);
}

TEST(Pace, SlowAndLiveBodiesRestUnderTheSameForce) {
  // Dashpots, ticks and tolerances decide how a body comes to rest, and not where.
  double forces[2];
  for (const Pace pace : {Pace::slow, Pace::live}) {
    Specimen specimen = block({72e-3, 72e-3, 48e-3}, 4e-3, pace, {20e-3});
    specimen.friction = 0;
    const Result<Body> body = make_body(specimen);
    ASSERT_TRUE(bool(body)) << to_string(body.errors()[0]);
    const PressSite site{{0, 0, 48e-3}, {0, 0, -1}};
    const double depth[] = {3e-3};
    if (pace == Pace::slow) {
      forces[0] = press(*body, 0, site, depth)[0].force;
      continue;
    }
    stepping::Stepper stepper(body->model);
    State state = rest_state(body->model);
    for (int tick = 1; tick <= 3000; ++tick)
      forces[1] =
          stepper.step(state, ball_at(0, ball_centre(*body, 0, site, std::min(3e-3, 1e-5 * tick)))).tool_force.z;
  }
  EXPECT_GT(forces[0], 0.1);
  EXPECT_NEAR(forces[1] / forces[0], 1, 2e-3);
}

TEST(Spread, KnowsMeanScatterAndRatio) {
  const Spread spread = spread_of({1, 3});
  EXPECT_DOUBLE_EQ(spread.mean, 2);
  EXPECT_DOUBLE_EQ(spread.deviation, 0.5);
  EXPECT_DOUBLE_EQ(spread.ratio(), 3);
  EXPECT_TRUE(std::isinf(spread_of({0, 1}).ratio())) << "a place without a force";
  EXPECT_TRUE(std::isinf(spread_of({0, 0}).deviation));
}

TEST(Order, IsTheExponentOfTheError) {
  EXPECT_NEAR(order_of({4, 2, 1}, {0.32, 0.08, 0.02}), 2, 1e-12);
  EXPECT_TRUE(std::isnan(order_of({4}, {0.1})));
}

}  // namespace
}  // namespace ctpm::fidelity
