// Which spheres bear what a blade does.

#include "core/cutting/bearing.h"

#include <gtest/gtest.h>

#include "core/cutting/rest_map.h"
#include "tests/core/blade_blocks.h"

namespace ctpm {
namespace {

using testing::blade_at;
using testing::make_block_model;

/// A block, its elements, and the sphere in its middle.
struct BearingTest : ::testing::Test {
  BearingTest()
      : model(make_block_model(5, 5, 5)), elements(model), bearing(model, elements), state(rest_state(model)) {
    state.axial_severed.assign(model.axial.size(), 0);
  }
  /// Severs all elements of the sphere but the first `whole`.
  void leave(std::size_t whole) {
    state.axial_severed.assign(model.axial.size(), 0);
    const auto all = elements.of(std::size_t(kMiddle));
    for (std::size_t i = whole; i < all.size(); ++i) state.axial_severed[std::size_t(all[i])] = 1;
    bearing.update(state);
  }

  static constexpr std::int32_t kMiddle = 62;
  Model model;
  cutting::RestElements elements;
  cutting::Bearing bearing;
  State state;
};

TEST_F(BearingTest, ASphereBearsLessTheFewerOfItsElementsAreWhole) {
  const std::size_t all = elements.of(kMiddle).size();
  EXPECT_EQ(bearing.share(kMiddle), 1) << "before anything is severed";
  double last = 0;
  for (std::size_t whole = 0; whole <= all; ++whole) {
    leave(whole);
    const double share = bearing.share(kMiddle);
    EXPECT_GE(share, last);
    if (10 * whole < all) {
      EXPECT_LT(share, 0.01);
    }
    if (2 * whole >= all) {
      EXPECT_EQ(share, 1) << "beside a cut";
    }
    EXPECT_GT(share, 0) << "it bears where there is nothing else";
    last = share;
  }
  leave(0);
  state.axial_severed.assign(model.axial.size(), 0);
  bearing.update(state);
  EXPECT_EQ(bearing.share(kMiddle), 1) << "of a State before the cut";
}

TEST_F(BearingTest, WhatFellAwayCarriesNothingAtTheBlade) {
  const cutting::RestMap map(model);
  const Vec3 rest{-0.001, 0, 0.02};
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.rest_position[i].x > 0) state.position.add(i, {0.1, 0, -0.3});
  cutting::Place all, near;
  const cutting::BladeAt blade{bearing, state.position, rest};
  map.find(0, rest, 0.02, all);
  map.find(0, rest, 0.02, near, &blade);
  EXPECT_GT(norm(all.at(state.position) - rest), 0.01);
  EXPECT_LT(norm(near.at(state.position) - rest), 1e-9);
  ASSERT_GT(near.count, 4);
  for (std::int32_t i = 0; i < near.count; ++i)
    EXPECT_LE(model.rest_position[std::size_t(near.sphere[std::size_t(i)])].x, 0);
}

TEST_F(BearingTest, TissueThatIsStretchedTwiceAndTurnedBearsAsBefore) {
  const cutting::RestMap map(model);
  const Vec3 rest{-0.001, 0.002, 0.02};
  const auto move = [](Vec3 p) { return rotate({0.6, 0, 0, 0.8}, {2 * p.x, 0.7 * p.y, 0.7 * p.z}); };
  for (std::size_t i = 0; i < model.sphere_count(); ++i) state.position.set(i, move(model.rest_position[i]));
  cutting::Place without, with;
  const cutting::BladeAt blade{bearing, state.position, move(rest)};
  map.find(0, rest, 0.02, without);
  map.find(0, rest, 0.02, with, &blade);
  ASSERT_EQ(with.count, without.count);
  for (std::size_t i = 0; i < std::size_t(with.count); ++i) EXPECT_EQ(with.weight[i], without.weight[i]);
}

/// A crumb of one sphere beside the blade's way is not thrown ahead of it.
TEST_F(BearingTest, ACrumbIsNotFlung) {
  const double per_tick = 4e-5;
  model = testing::held_block(6, 6, 5);
  for (auto& held : model.held_axes) held = 0;
  for (std::int32_t i = 0; i < 36; ++i) model.held_axes[std::size_t(i)] = kAnchored;
  State cut = rest_state(model);
  const cutting::RestElements elements(model);
  const std::int32_t crumb = 3 + 6 * (3 + 6 * 3);
  for (const std::int32_t e : elements.of(std::size_t(crumb))) cut.axial_severed[std::size_t(e)] = 1;
  for (std::size_t i = 0; i < model.constraints.size(); ++i)
    for (const auto& edge : model.constraints.edge)
      if (cut.axial_severed[std::size_t(edge[i])]) cut.constraint_severed[i] = 1;
  stepping::Stepper stepper(model);
  double fastest = 0;
  const double x = model.rest_position[std::size_t(crumb)].x - 0.004;
  for (int i = 0; i < 2500; ++i) {
    const stepping::StepReport report = stepper.step(cut, blade_at({x, -0.05 + i * per_tick, -0.05}));
    ASSERT_FALSE(stepping::is_refused(report.status));
    fastest = std::max(fastest, norm(cut.velocity[std::size_t(crumb)]));
  }
  EXPECT_LT(fastest, 2 * per_tick / model.tick);
}

}  // namespace
}  // namespace ctpm
