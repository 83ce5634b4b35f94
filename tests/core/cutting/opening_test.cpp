// The jump of a value across a cut.

#include "core/cutting/opening.h"

#include <gtest/gtest.h>

#include "tests/core/blocks.h"

namespace ctpm {
namespace {

constexpr Vec3 kPlace{0.0013, 0.0021, 0.027};

class OpeningTest : public ::testing::Test {
 protected:
  OpeningTest() : model(testing::make_block_model(6, 6, 6)), map(model), openings(model, map) {}

  cutting::Opening at(Vec3 rest, Vec3 normal) const {
    cutting::Opening opening;
    openings.find(0, rest, normal, opening);
    return opening;
  }

  static cutting::Opening::Values off_cut(const cutting::Opening& opening, const Vec3Array& position, Vec3 across) {
    cutting::Opening::Values values{};
    for (std::size_t i = 0; i < std::size_t(opening.count); ++i)
      values[i] = dot(across, position[std::size_t(opening.sphere[i])]) - opening.apart[i];
    return values;
  }

  Model model;
  cutting::RestMap map;
  cutting::Openings openings;
};

TEST_F(OpeningTest, IsNoneWhereTheTissueOnlyTurnsAndShearsAlongTheCut) {
  for (const Vec3 wild : {Vec3{1, 0, 0}, Vec3{0.8, 0.6, 0}, Vec3{0.3, -0.5, 0.7}}) {
    const Vec3 normal = wild / norm(wild);
    const cutting::Opening opening = at(kPlace, normal);
    ASSERT_EQ(opening.whole, 1);
    double sum = 0;
    for (std::size_t i = 0; i < std::size_t(opening.count); ++i) sum += opening.weight[i];
    EXPECT_NEAR(sum, 0, 1e-14);
    const Quat turn{0.8, 0.36, 0.48, 0};
    Vec3Array position = model.rest_position;
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vec3 p = position[i];
      const Vec3 sheared = p + 0.2 * dot(normal, p) * cross(normal, {0.1, 0.2, 0.9});
      position.set(i, rotate(turn, sheared) + Vec3{0.3, 0.1, -0.2});
    }
    EXPECT_NEAR(opening.jump(off_cut(opening, position, rotate(turn, normal))), 0, 1e-12);
  }
}

TEST_F(OpeningTest, IsHowFarOneSideMovesFromTheOther) {
  const Vec3 normal{0.8, 0.6, 0};
  const cutting::Opening opening = at(kPlace, normal);
  Vec3Array position = model.rest_position;
  for (std::size_t i = 0; i < position.size(); ++i)
    if (dot(normal, position[i] - kPlace) > 0) position.add(i, 0.7e-3 * normal + Vec3{-0.6e-3, 0.8e-3, 0.5e-3});
  EXPECT_NEAR(opening.jump(off_cut(opening, position, normal)), 0.7e-3, 1e-12);
}

TEST_F(OpeningTest, ChangesAlongTheCutAsFiniteDifferencesTell) {
  State state = rest_state(model);
  testing::shake(state, 1e-3);
  const Vec3 normal{0.8, 0.6, 0}, along[] = {{0, 0, 1}, {-0.6, 0.8, 0}};
  const cutting::Opening opening = at(kPlace, normal);
  const Vec3 change = opening.change(off_cut(opening, state.position, normal));
  EXPECT_NEAR(dot(change, normal), 0, 1e-12);
  constexpr double kStep = 1e-7;
  for (const Vec3 way : along) {
    const auto jump = [&](double by) {
      const cutting::Opening there = at(kPlace + by * way, normal);
      return there.jump(off_cut(there, state.position, normal));
    };
    const double expected = (jump(kStep) - jump(-kStep)) / (2 * kStep);
    EXPECT_NEAR(dot(change, way), expected, 1e-6 * std::abs(expected) + 1e-8);
    EXPECT_GT(std::abs(expected), 1e-3);
  }
}

TEST_F(OpeningTest, HasNoJumpWhereASphereChangesSides) {
  State state = rest_state(model);
  testing::shake(state, 1e-3);
  const Vec3 normal{1, 0, 0};
  // A layer of spheres lies at x = 6 mm.
  double before = 0;
  for (int i = -300; i <= 300; ++i) {
    const cutting::Opening there = at({0.006 + 1e-5 * i, kPlace.y, kPlace.z}, normal);
    const double jump = there.jump(off_cut(there, state.position, normal));
    if (i > -300) {
      EXPECT_NEAR(jump, before, 5e-5) << i;
    }
    before = jump;
  }
}

TEST_F(OpeningTest, ThereIsNoneWhereOneSideHasNoTissue) {
  EXPECT_EQ(at({0.031, 0.0021, 0.027}, {1, 0, 0}).whole, 0);
  EXPECT_EQ(at({1, 1, 1}, {1, 0, 0}).whole, 0);
  // Towards the boundary it fades.
  double before = 1;
  for (double x = 0.02; x < 0.031; x += 1e-5) {
    const double whole = at({x, 0.0021, 0.027}, {1, 0, 0}).whole;
    EXPECT_LE(whole, before + 1e-12) << x;
    EXPECT_GT(whole, before - 0.2) << x;
    before = whole;
  }
}

}  // namespace
}  // namespace ctpm
