// Two hands, each with a tool. What is held in the second hand does what it would do in the first.

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "core/cutbody/cut_points.h"
#include "core/stepping/step.h"
#include "tests/core/blade_blocks.h"
#include "tests/core/cut_blocks.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

constexpr double kTop = 0.036, kRadius = 0.006;  // of a block of four layers, and of the balls [m]
enum : std::int32_t { kBall, kOtherBall, kScalpel, kOtherScalpel, kPin, kOtherPin, kSamePin };

std::vector<Tool> tools_of(const Model& model) {
  const auto last = std::int32_t(model.sphere_count()) - 1;
  const Tool pin{"pin", ToolKind::pin, 0, 0, last}, other{"other pin", ToolKind::pin, 0, 0, last - 4};
  return {
      testing::ball(kRadius), testing::ball(kRadius), testing::scalpel(0.06), testing::scalpel(0.06), pin, other, pin};
}

/// Soft enough for one step of leapfrog in a tick; nothing holds it unless `is_anchored`.
Model block(Integrator integrator, bool is_anchored = true, double toughness = 20) {
  network::Material material = testing::resisting(toughness, 500);
  material.viscosity = 5e3, material.stiffness_scale = 0.05;
  Model model = testing::make_skinned_block(5, 5, 4, network::Structure::mass_spring, 0.003, material);
  if (!is_anchored) model.held_axes.assign(model.sphere_count(), 0);
  model.tools = tools_of(model), model.hands = 2;
  testing::use_integrator(model, integrator);
  return model;
}

/// The same, solved to rounding.
Model exact_block(Integrator integrator, bool is_anchored = true) {
  Model model = block(integrator, is_anchored);
  model.solver.tolerance = 1e-11, model.solver.velocity_floor = 1e-14, model.solver.max_iterations = 2000;
  return model;
}

Hand hand(std::int32_t tool, Vec3 position) {
  Hand result;
  result.tool = tool, result.position = position;
  return result;
}

Inputs both(const Hand& first, const Hand& second) {
  Inputs inputs;
  static_cast<Hand&>(inputs) = first, inputs.second = second;
  return inputs;
}

/// A blade cuts along y beside x = 0.
Hand cut(int tick) { return hand(kScalpel, {0.0007, -0.034 + 0.0004 * tick, 0.02}); }

/// A ball goes down at a place.
Hand press(int tick, Vec3 place, std::int32_t ball = kBall) {
  return hand(ball, place + Vec3{0, 0, kTop + kRadius - 4e-5 * tick});
}

class Hands : public ::testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Under, Hands,
                         ::testing::Values(Integrator::leapfrog, Integrator::backward_euler, Integrator::sdirk2));

TEST_P(Hands, ASecondHandFarAwayChangesNoBit) {
  Model one = block(GetParam()), two = one;
  one.hands = 1;
  stepping::Stepper alone(one), beside(two);
  State of_one = rest_state(one), of_two = rest_state(two);
  std::int32_t severed = 0, contacts = 0;
  for (int tick = 0; tick < 300; ++tick) {
    const Hand first = tick < 100 ? press(tick, {}) : tick < 240 ? cut(tick - 100) : press(tick - 160, {0.001, 0, 0});
    const stepping::StepReport report = alone.step(of_one, both(first, {}));
    const stepping::StepReport other = beside.step(of_two, both(first, hand(kOtherBall, {1, 1e-3 * tick, 1})));
    ASSERT_FALSE(stepping::is_refused(report.status));
    ASSERT_EQ(of_one.position, of_two.position) << tick;
    ASSERT_EQ(of_one.velocity, of_two.velocity) << tick;
    EXPECT_EQ(static_cast<const stepping::HandReport&>(report), static_cast<const stepping::HandReport&>(other));
    EXPECT_EQ(other.second, stepping::HandReport{});
    severed += report.severed, contacts += report.contacts;
  }
  EXPECT_GT(severed, 0);
  EXPECT_GT(contacts, 0);
  EXPECT_EQ(of_one.swept, of_two.swept);
}

TEST_P(Hands, TheMomentumThatTheTissueGainsIsWhatBothHandsGive) {
  if (GetParam() == Integrator::sdirk2) GTEST_SKIP() << "it reports the force of its last stage";
  const auto pinned = [](const Model& model, int tick) {
    return hand(kPin, model.rest_position[model.sphere_count() - 1] + 1e-5 * tick * Vec3{0, 0, 1});
  };
  for (int pair = 0; pair < 4; ++pair) {
    const Model model = exact_block(GetParam(), false);
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    double least[2] = {0, 0};
    for (int tick = 0; tick < 60; ++tick) {
      const Hand pressing = press(tick, {-0.012, 0, 0});
      const Inputs inputs = pair == 0   ? both(pressing, press(tick, {0.012, 0.004, 0}, kOtherBall))
                            : pair == 1 ? both(pressing, cut(tick))
                            : pair == 2 ? both(cut(tick), pinned(model, tick))
                                        : both(pinned(model, tick), pressing);
      const Vec3 before = testing::momentum(model, state);
      const stepping::StepReport report = stepper.step(state, inputs);
      ASSERT_EQ(report.status, stepping::StepStatus::ok);
      const Vec3 given = -model.tick * (report.tool_force + report.second.tool_force);
      const double size = model.tick * (norm(report.tool_force) + norm(report.second.tool_force));
      ASSERT_NEAR(norm(testing::momentum(model, state) - before - given), 0, 1e-6 * size + 1e-12)
          << pair << " " << tick;
      least[0] = std::max(least[0], norm(report.tool_force));
      least[1] = std::max(least[1], norm(report.second.tool_force));
    }
    EXPECT_GT(least[0], 1e-3) << pair;
    EXPECT_GT(least[1], 1e-3) << pair;
  }
}

TEST_P(Hands, PressesFromTwoSidesGiveOppositeForces) {
  const Model model = exact_block(GetParam(), false);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  double most = 0;
  for (int tick = 0; tick < 200; ++tick) {
    const double x = 0.024 + kRadius - 2e-5 * tick;
    const stepping::StepReport report =
        stepper.step(state, both(hand(kBall, {-x, 0.001, 0.016}), hand(kOtherBall, {x, 0.001, 0.016})));
    const Vec3 left = report.tool_force, right = report.second.tool_force;
    most = std::max(most, norm(left));
    ASSERT_NEAR(norm(left - Vec3{-right.x, right.y, right.z}), 0, 1e-7 * (1e-3 + norm(left))) << tick;
    ASSERT_EQ(report.contacts, report.second.contacts);
    ASSERT_NEAR(report.depth, report.second.depth, 1e-9);
  }
  EXPECT_GT(most, 0.01);
}

TEST_P(Hands, EachDoesWhatTheOtherWould) {
  const Model model = exact_block(GetParam());
  stepping::Stepper stepper(model), swapped(model);
  State state = rest_state(model), other = rest_state(model);
  std::int32_t severed = 0;
  for (int tick = 0; tick < 120; ++tick) {
    const Hand a = press(tick, {-0.012, 0, 0}), b = cut(tick);
    const stepping::StepReport report = stepper.step(state, both(a, b)), reverse = swapped.step(other, both(b, a));
    ASSERT_EQ(report.severed, reverse.severed) << tick;
    ASSERT_NEAR(norm(report.tool_force - reverse.second.tool_force), 0, 1e-6 * (1e-2 + norm(report.tool_force)));
    ASSERT_NEAR(norm(report.second.tool_force - reverse.tool_force), 0, 1e-6 * (1e-2 + norm(reverse.tool_force)));
    severed += report.severed;
  }
  EXPECT_GT(severed, 0);
}

TEST_P(Hands, TwoPinsHoldTheirSpheresWhereTheHandsAre) {
  const Model model = block(GetParam());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  const auto a = std::size_t(model.tools[kPin].sphere), b = std::size_t(model.tools[kOtherPin].sphere);
  stepping::StepReport report;
  for (int tick = 1; tick <= 100; ++tick) {
    const Vec3 by = 1e-5 * tick * Vec3{0, 1, 0};
    report = stepper.step(state,
                          both(hand(kPin, model.rest_position[a] + by), hand(kOtherPin, model.rest_position[b] - by)));
    EXPECT_NEAR(norm(state.position[a] - (model.rest_position[a] + by)), 0, 1e-12);
    EXPECT_NEAR(norm(state.position[b] - (model.rest_position[b] - by)), 0, 1e-12);
  }
  EXPECT_NEAR(report.depth, 1e-3, 1e-12);
  EXPECT_NEAR(report.second.depth, 1e-3, 1e-12);
  EXPECT_LT(report.tool_force.y, 0);
  EXPECT_GT(report.second.tool_force.y, 0);
}

TEST_P(Hands, NeitherThreadsNorAFreshStartChangeABit) {
  // So weak that the blade cuts it rather than to take it along: the ball finds the cut where it was made.
  const Model model = block(GetParam(), true, 5);
  const cutbody::CutPoints points(model);
  std::vector<State> runs;
  bool touches_cut = false;
  for (const auto& [threads, from_keyframes] : {std::pair{1, false}, {3, false}, {1, true}}) {
    State state = rest_state(model);
    std::optional<stepping::Stepper> stepper;
    stepper.emplace(model, stepping::StepperOptions{threads});
    // The first hand cuts and then presses; then the second one cuts across, beside the ball in the first cut.
    for (int tick = 0; tick < 420; ++tick) {
      if (from_keyframes && tick % 70 == 69) stepper.emplace(model);
      const Hand across = hand(kOtherScalpel, {-0.034 + 0.0004 * (tick - 260), 0.0093, 0.02});
      const Inputs inputs = tick < 170   ? both(cut(tick), press(tick, {-0.014, 0, 0}, kOtherBall))
                            : tick < 260 ? both({}, press(tick - 100, {0.001, 0.002, 0}, kOtherBall))
                                         : both(press(tick - 200, {0.001, -0.008, 0}), across);
      ASSERT_FALSE(stepping::is_refused(stepper->step(state, inputs).status)) << tick;
      testing::open_soon(state);
      for (const std::int32_t point : state.touched)
        touches_cut = touches_cut || (points.contains(point) && points.is_of_ball(point, 1));
    }
    runs.push_back(std::move(state));
  }
  EXPECT_TRUE(touches_cut) << "the second hand's ball touches what the first hand cut";
  for (const State& other : {runs[1], runs[2]}) {
    EXPECT_EQ(runs[0].position, other.position);
    EXPECT_EQ(runs[0].velocity, other.velocity);
    EXPECT_EQ(runs[0].touched, other.touched);
    EXPECT_EQ(runs[0].grip, other.grip);
    EXPECT_EQ(runs[0].swept, other.swept);
  }
}

TEST(TwoHands, ABladeThatGoesFromHandToHandCutsNothingOnItsWay) {
  const Model model = block(Integrator::backward_euler);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int tick = 0; tick < 60; ++tick) (void)stepper.step(state, both(cut(tick), {}));
  const State before = state;
  const stepping::StepReport report = stepper.step(state, both({}, hand(kScalpel, {0.015, 0.01, 0.02})));
  EXPECT_EQ(report.status, stepping::StepStatus::ok);
  EXPECT_EQ(report.severed, 0);
  EXPECT_EQ(state.axial_severed, before.axial_severed);
}

TEST(TwoHands, CannotHoldWhatDoesNotGoTogether) {
  Model model = block(Integrator::backward_euler);
  const auto is_refused = [&](const Inputs& inputs) {
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    const bool refused = stepper.step(state, inputs).status == stepping::StepStatus::bad_input;
    EXPECT_EQ(state.tick, refused ? 0 : 1);
    return refused;
  };
  const auto holding = [](std::int32_t a, std::int32_t b) { return both(hand(a, {0, 0, 1}), hand(b, {0, 0, 2})); };
  EXPECT_TRUE(is_refused(holding(kBall, kBall)));
  EXPECT_TRUE(is_refused(holding(kScalpel, kOtherScalpel)));
  EXPECT_TRUE(is_refused(holding(kPin, kSamePin)));
  EXPECT_TRUE(is_refused(holding(kBall, 99)));
  EXPECT_TRUE(is_refused(holding(kBall, -2)));
  EXPECT_FALSE(is_refused(holding(kBall, kOtherBall)));
  EXPECT_FALSE(is_refused(holding(-1, kBall)));
  EXPECT_FALSE(is_refused(holding(kScalpel, kBall)));
  EXPECT_FALSE(is_refused(both(hand(kPin, model.rest_position[0]), hand(kOtherPin, model.rest_position[1]))));
  model.hands = 1;
  EXPECT_TRUE(is_refused(holding(kBall, kOtherBall))) << "the scene has one hand";
  EXPECT_EQ(stepping::hands_conflict(model, kBall, kBall), "both hands hold the same tool");
}

}  // namespace
}  // namespace ctpm
