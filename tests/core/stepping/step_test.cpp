#include "core/stepping/step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/elements/forces.h"
#include "core/model/fields.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

using testing::ball;
using testing::make_block_model;
using testing::scalpel;
using testing::shake;

Inputs tool_at(Vec3 position, std::int32_t tool = 0) {
  Inputs inputs;
  inputs.tool = tool;
  inputs.position = position;
  return inputs;
}

TEST(Step, AFreeBlockFallsAsGalileoSays) {
  Model model = make_block_model(3, 3, 3);
  model.held_axes.assign(model.sphere_count(), 0);
  model.gravity = {0, 0, -9.81};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int i = 0; i < 500; ++i) ASSERT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
  const double t = 0.5, h = 1e-3;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    // Each tick solves the acceleration to 1e-4; (t + h) / 2 includes backward Euler's error of half a tick.
    EXPECT_NEAR(state.velocity.z[i], -9.81 * t, 1e-3 * 9.81 * t);
    EXPECT_NEAR(state.position.z[i] - model.rest_position.z[i], -9.81 * t * (t + h) / 2, 1e-3);
  }
}

TEST(Step, HoldsTheLiversStiffDashpotsAtOneMillisecond) {
  Model model = make_block_model(9, 9, 7);
  model.tools = {ball(0.002)};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  const double top = 0.072 + 0.006 + 0.002;
  stepping::StepReport report;
  for (int i = 0; i < 2000; ++i) {
    const double depth = std::min(0.010, 0.010 * i / 1000.0);
    report = stepper.step(state, tool_at({0, 0, top - depth}));
    ASSERT_EQ(report.status, stepping::StepStatus::ok) << "tick " << i;
  }
  EXPECT_GT(report.tool_force.z, 0.5);
  EXPECT_LT(report.tool_force.z, 10);
  EXPECT_NEAR(report.depth, 0.010, 0.0015);  // the penalty contact allows some overlap
}

TEST(Step, EnergyOfAShakenBlockOnlyFalls) {
  Model model = make_block_model(5, 5, 5);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  shake(state, 0.001, 0.05);
  for (std::size_t i = 0; i < 25; ++i) state.position.set(i, model.rest_position[i]), state.velocity.set(i, {});
  const auto energy = [&] {
    double sum = elements::elastic_energy(model, state);
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      sum += 0.5 * model.mass[i] * dot(state.velocity[i], state.velocity[i]);
    return sum;
  };
  double last = energy();
  for (int i = 0; i < 300; ++i) {
    ASSERT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
    const double now = energy();
    ASSERT_LE(now, last * (1 + 1e-6)) << "tick " << i;
    last = now;
  }
}

TEST(Step, AnchoredSpheresNeverMove) {
  Model model = make_block_model(4, 4, 4);
  model.gravity = {0, 0, -9.81};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int i = 0; i < 100; ++i) (void)stepper.step(state, {});
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(state.position[i], model.rest_position[i]);
  EXPECT_LT(state.position.z[63], model.rest_position.z[63]);
}

TEST(Step, SameInputsGiveTheSameBits) {
  Model model = make_block_model(6, 6, 5);
  model.tools = {ball(0.006)};
  State first, second;
  for (State* state : {&first, &second}) {
    stepping::Stepper stepper(model);
    *state = rest_state(model);
    for (int i = 0; i < 200; ++i) (void)stepper.step(*state, tool_at({0, 0, 0.066 - 0.0001 * i}));
  }
  EXPECT_EQ(first.position, second.position);
  EXPECT_EQ(first.velocity, second.velocity);
}

/// Moduli at which the explicit integrator is stable too.
network::Material soft_material() {
  network::Material material = testing::liver_material();
  material.viscosity = 5e3, material.stiffness_scale = 0.3;
  return material;
}

std::uint64_t bits_of(const State& state) {
  std::uint64_t sum = 0;
  for_each_field(state, [&](std::string_view, const auto& member) {
    const auto add = [&](const auto& value) {
      unsigned char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      for (const unsigned char byte : bytes) sum = (sum ^ byte) * 1099511628211ull;
    };
    if constexpr (requires { member.begin(); })
      for (const auto& value : member) add(value);
    else
      add(member);
  });
  return sum;
}

class EveryIntegrator : public ::testing::TestWithParam<Integrator> {};

TEST_P(EveryIntegrator, GoesOnFromAnyStateOfAnyMoment) {
  Model model = make_block_model(5, 5, 5, network::Structure::ctpm, soft_material());
  testing::use_integrator(model, GetParam());
  model.tools = {ball(0.006), scalpel(0.05)};
  const auto inputs = [](int i) { return tool_at({-0.04 + 0.0008 * i, 0.0003, 0.03}, i < 60 ? 0 : 1); };
  stepping::Stepper stepper(model);
  State state = rest_state(model), saved;
  for (int i = 0; i < 120; ++i) {
    if (i == 70) saved = state;
    ASSERT_FALSE(stepping::is_refused(stepper.step(state, inputs(i)).status));
  }
  for (int i = 70; i < 120; ++i) (void)stepper.step(saved, inputs(i));
  EXPECT_EQ(bits_of(saved), bits_of(state));
}

TEST_P(EveryIntegrator, LeavesTheStateOfARefusedTickToTheBit) {
  for (const int substeps : {1, 3})
    for (const network::Structure structure : {network::Structure::ctpm, network::Structure::tpm}) {
      Model model = make_block_model(4, 4, 4, structure, soft_material());
      testing::use_integrator(model, GetParam()), model.solver.substeps = substeps;
      model.tools = {Tool{"pin", ToolKind::pin, 0, 0, 60}};
      stepping::Stepper stepper(model);
      State state = rest_state(model);
      const auto pull = [&](int i) { return tool_at(model.rest_position[60] + Vec3{0, 0, 1e-4 * i}); };
      for (int i = 1; i < 10; ++i) ASSERT_FALSE(stepping::is_refused(stepper.step(state, pull(i)).status));
      state.velocity.y[40] = NAN;
      const std::uint64_t before = bits_of(state);
      EXPECT_EQ(stepper.step(state, pull(10)).status, stepping::StepStatus::diverged);
      EXPECT_EQ(bits_of(state), before) << substeps << " substeps, structure " << int(structure);
    }
}

TEST_P(EveryIntegrator, LeavesTheStateOfARefusedCutToTheBit) {
  Model model = make_block_model(4, 4, 4, network::Structure::ctpm, soft_material());
  testing::use_integrator(model, GetParam()), model.tools = {scalpel(0.1)};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  const auto cut = [&](int i) { return tool_at({0.0003, -0.03 + 0.002 * i, -0.01}); };
  for (int i = 0; i < 15; ++i) ASSERT_FALSE(stepping::is_refused(stepper.step(state, cut(i)).status));
  const double good = std::exchange(state.velocity.y[40], NAN);
  const std::uint64_t before = bits_of(state);
  const stepping::StepReport refused = stepper.step(state, cut(20));
  EXPECT_EQ(refused.status, stepping::StepStatus::diverged);
  EXPECT_EQ(refused.severed, 0) << "nothing of a refused tick has happened";
  EXPECT_EQ(bits_of(state), before);
  state.velocity.y[40] = good;
  EXPECT_GT(stepper.step(state, cut(20)).severed, 0) << "the refused tick was a cut";
}

INSTANTIATE_TEST_SUITE_P(Under, EveryIntegrator,
                         ::testing::Values(Integrator::leapfrog, Integrator::backward_euler, Integrator::sdirk2));

TEST(Step, RefusesPosesThatAreNotNumbersAndLeavesTheState) {
  Model model = make_block_model(3, 3, 3);
  model.tools = {ball(0.006)};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  const State before = state;
  for (const Inputs& inputs :
       {tool_at({NAN, 0, 0}), tool_at({INFINITY, 0, 0}), tool_at({0, 0, 0}, 7), tool_at({0, 0, 0}, -2)}) {
    EXPECT_EQ(stepper.step(state, inputs).status, stepping::StepStatus::bad_input);
    EXPECT_EQ(state.tick, before.tick);
    EXPECT_EQ(state.position, before.position);
  }
}

TEST(Step, SaysWhichSphereDivergedAndLeavesTheState) {
  Model model = make_block_model(3, 3, 3);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  state.velocity.x[20] = NAN;
  const stepping::StepReport report = stepper.step(state, {});
  EXPECT_EQ(report.status, stepping::StepStatus::diverged);
  EXPECT_GE(report.worst_sphere, 0);
  EXPECT_EQ(state.tick, 0);
  EXPECT_EQ(state.position, model.rest_position);
}

TEST(Contact, ForceOnTheToolBalancesForceOnTheAnchors) {
  // At rest, the anchored spheres carry the force on the tool.
  Model model = make_block_model(5, 5, 4);
  model.tools = {ball(0.010)};
  model.solver.tolerance = 1e-8;
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  stepping::StepReport report;
  for (int i = 0; i < 6000; ++i)
    report = stepper.step(state, tool_at({0, 0, 0.036 + 0.006 + 0.010 - std::min(0.005, 1e-5 * i)}));
  const Vec3Array force = elements::internal_forces(model, state);
  Vec3 anchors;
  for (std::size_t i = 0; i < 25; ++i) anchors += force[i];
  EXPECT_GT(report.tool_force.z, 0.1);
  EXPECT_NEAR(norm(anchors + report.tool_force), 0, 1e-4 * norm(report.tool_force));
}

TEST(Contact, NeverPullsTheTissueAlong) {
  Model model = make_block_model(5, 5, 4);
  model.tools = {ball(0.010)};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  for (int i = 0; i < 500; ++i) (void)stepper.step(state, tool_at({0, 0, 0.045}));
  for (int i = 0; i < 200; ++i) {
    const stepping::StepReport report = stepper.step(state, tool_at({0, 0, 0.045 + 0.0005 * i}));
    ASSERT_GE(report.tool_force.z, 0) << "tick " << i;
  }
}

TEST(Cutting, AFullCutSeparatesTheBlockExactly) {
  Model model = make_block_model(6, 4, 4);
  model.tools = {scalpel(0.2)};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  // The blade reaches from above the block to below it and passes between the third and fourth plane in x.
  std::int32_t severed = 0;
  for (int i = 0; i < 100; ++i) severed += stepper.step(state, tool_at({0.0001, -0.05 + 0.001 * i, -0.05})).severed;
  EXPECT_GT(severed, 0);
  for (std::size_t e = 0; e < model.axial.size(); ++e) {
    const bool crosses = (model.rest_position.x[std::size_t(model.axial.a[e])] < 0) !=
                         (model.rest_position.x[std::size_t(model.axial.b[e])] < 0);
    EXPECT_EQ(state.axial_severed[e] != 0, crosses) << "edge " << e;
  }
}

TEST(Cutting, IsExactHoweverFastTheBladeMoves) {
  for (const int ticks : {2, 7, 50}) {
    Model model = make_block_model(6, 4, 4);
    model.tools = {scalpel(0.2)};
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    for (int i = 0; i < ticks; ++i) (void)stepper.step(state, tool_at({0.0001, -0.05 + 0.1 * i / (ticks - 1), -0.05}));
    for (std::size_t e = 0; e < model.axial.size(); ++e) {
      const bool crosses = (model.rest_position.x[std::size_t(model.axial.a[e])] < 0) !=
                           (model.rest_position.x[std::size_t(model.axial.b[e])] < 0);
      EXPECT_EQ(state.axial_severed[e] != 0, crosses) << ticks << " ticks, edge " << e;
    }
  }
}

TEST(Cutting, AToolThatIsTakenInHandDoesNotCutOnItsWay) {
  Model model = make_block_model(6, 4, 4);
  model.tools = {scalpel(0.2)};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  EXPECT_EQ(stepper.step(state, tool_at({0.0001, 0.05, -0.05})).severed, 0);
}

TEST(Settle, ComesToRestUnderGravityWithoutAdvancingTheTick) {
  Model model = make_block_model(4, 4, 4);
  model.gravity = {0, 0, -9.81};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  (void)stepper.settle(state, 20000);
  EXPECT_EQ(state.tick, 0);
  const Vec3Array force = elements::internal_forces(model, state);
  for (std::size_t i = 16; i < model.sphere_count(); ++i)
    EXPECT_NEAR(force.z[i], 9.81 * model.mass[i], 2e-3 * 9.81 * model.mass[i] + 1e-4);
}

}  // namespace
}  // namespace ctpm
