#include <gtest/gtest.h>

#include <cmath>

#include "core/stepping/step.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

using testing::ball;
using testing::make_block_model;

Inputs tool_at(Vec3 position) {
  Inputs inputs;
  inputs.tool = 0, inputs.position = position;
  return inputs;
}

/// One free sphere.
Model make_free_sphere(Integrator integrator, double tick) {
  Model model = make_block_model(1, 1, 1, network::Structure::mass_spring);
  model.held_axes = {0};
  testing::use_integrator(model, integrator), model.tick = tick;
  model.solver.tolerance = 1e-10, model.solver.velocity_floor = 1e-12;
  return model;
}

class AContact : public ::testing::TestWithParam<Integrator> {};

/// Rebound speed [m/s] of a sphere that hits a resting ball at 30 mm/s.
double rebound(Integrator integrator, double damping) {
  Model model = make_free_sphere(integrator, 2e-6);
  model.contact_friction = 0, model.contact_damping = damping, model.tools = {ball(0.02)};
  State state = rest_state(model);
  state.velocity.set(0, {0, 0, 0.03});
  const Inputs still = tool_at({0, 0, 0.02 + model.contact_radius[0] + 1e-5});
  stepping::Stepper stepper(model);
  for (int i = 0; i < 2500; ++i) EXPECT_EQ(stepper.step(state, still).status, stepping::StepStatus::ok);
  return -state.velocity.z[0];
}

TEST_P(AContact, BouncesByHuntAndCrossleysLawForEachDamping) {
  const double standard = Model{}.contact_damping;
  EXPECT_EQ(standard, 50);
  for (const double damping : {0.4 * standard, standard, 2 * standard}) {
    const double out = rebound(GetParam(), damping);
    // m v dv = -k p (1 + c p') dp from first to last touch: x - ln(1 + x) = -y - ln(1 - y) of both speeds times c.
    const double x = damping * 0.03, y = damping * out;
    EXPECT_GT(out, 0);
    EXPECT_NEAR(-y - std::log(1 - y), x - std::log(1 + x), 0.05) << damping << " s/m";
  }
  EXPECT_NEAR(std::pow(rebound(GetParam(), standard) / 0.03, 2), 0.25, 0.03);
  EXPECT_NEAR(rebound(GetParam(), 0), 0.03, 3e-4) << "without damping nothing is lost";
}

TEST_P(AContact, HoldsWhatItGripsAndSlidesBeyondTheCone) {
  const double radius = 100, press = 0.05;
  for (const double share : {0.5, 0.9, 1.5}) {  // of the friction cone
    Model model = make_free_sphere(GetParam(), 1e-4);
    const double push = share * model.contact_friction * press;
    model.tools = {ball(radius)};
    model.loads.sphere = {0}, model.loads.force.push_back({push, 0, press});
    model.loads.start = {0}, model.loads.ramp = {0.02};
    State state = rest_state(model);
    stepping::Stepper stepper(model);
    const Inputs still = tool_at({0, 0, radius + model.contact_radius[0]});
    stepping::StepReport report;
    for (int i = 0; i < 1000; ++i) report = stepper.step(state, still);
    const Vec3 early = state.position[0];
    for (int i = 0; i < 3000; ++i) report = stepper.step(state, still);
    const double moved = state.position.x[0] - early.x;
    if (share < 1) {
      EXPECT_NEAR(moved, 0, 1e-9) << "nothing creeps under " << share << " of the cone";
      EXPECT_NEAR(report.tool_force.x, push, 1e-3 * push);
      EXPECT_LT(state.position.x[0], 2 * model.contact_friction * press / model.contact_k);
    } else {
      // The rest of the push accelerates it for 0.4 s, but for the ramp.
      const double rest = push - model.contact_friction * press, fast = state.velocity.x[0];
      EXPECT_NEAR(report.tool_force.x, model.contact_friction * press, 0.02 * push);
      EXPECT_NEAR(fast * model.mass[0], rest * 0.39, 0.03 * rest);
    }
  }
}

TEST_P(AContact, SlidesUnderCoulombsLawAndThenSticks) {
  // The ball is so large that the path is straight.
  Model model = make_free_sphere(GetParam(), 2e-5);
  const double radius = 100, press = 0.05, speed = 0.02;
  model.tools = {ball(radius)};
  model.loads.sphere = {0}, model.loads.force.push_back({0, 0, press});
  model.loads.start = {0}, model.loads.ramp = {0};
  State state = rest_state(model);
  state.position.z[0] = press / model.contact_k;
  state.velocity.set(0, {speed, 0, 0});
  const Inputs still = tool_at({0, 0, radius + model.contact_radius[0]});
  stepping::Stepper stepper(model);
  const double slowing = model.contact_friction * press / model.mass[0], stops = speed / slowing;
  ASSERT_GT(stops, 20 * model.tick);
  while ((double(state.tick) + 1) * model.tick < 0.9 * stops) {
    const stepping::StepReport report = stepper.step(state, still);
    ASSERT_EQ(report.status, stepping::StepStatus::ok);
    EXPECT_NEAR(state.velocity.x[0], speed - slowing * double(state.tick) * model.tick, 0.02 * speed);
    EXPECT_NEAR(report.tool_force.x, model.contact_friction * press, 0.05 * press);
  }
  for (int i = 0; i < 5000; ++i) ASSERT_EQ(stepper.step(state, still).status, stepping::StepStatus::ok);
  EXPECT_NEAR(state.velocity.x[0], 0, 1e-3 * speed);
  // Where it stops, the grip recoils.
  const double recoil = model.contact_friction * press / model.contact_k;
  EXPECT_NEAR(state.position.x[0], 0.5 * speed * stops - recoil, 0.05 * speed * stops);
}

TEST_P(AContact, IsTheSameInSubstepsAsInTicks) {
  const auto press = [&](int substeps) {
    Model model = make_free_sphere(GetParam(), 4e-4 / (5 - substeps));
    model.tools = {ball(0.02)}, model.solver.substeps = substeps;
    State state = rest_state(model);
    stepping::Stepper stepper(model);
    const auto hand = [&](double time) { return tool_at({0, 0.001, 0.0199 + model.contact_radius[0] - 0.05 * time}); };
    state.last_inputs = hand(0);
    while (double(state.tick) * model.tick < 0.004 - 0.5 * model.tick)
      EXPECT_EQ(stepper.step(state, hand(double(state.tick + 1) * model.tick)).status, stepping::StepStatus::ok);
    return state;
  };
  const State in_ticks = press(1), in_substeps = press(4);
  EXPECT_NEAR(norm(in_substeps.position[0] - in_ticks.position[0]), 0, 1e-12);
  EXPECT_NEAR(norm(in_substeps.velocity[0] - in_ticks.velocity[0]), 0, 1e-9);
  EXPECT_GT(norm(in_ticks.velocity[0]), 1e-3);
}

TEST_P(AContact, DoesNotMoveASphereOffItsGuide) {
  Model model = make_free_sphere(GetParam(), 1e-4);
  model.held_axes = {1}, model.tools = {ball(0.02)};
  State state = rest_state(model);
  stepping::Stepper stepper(model);
  for (int i = 0; i < 20; ++i)
    ASSERT_EQ(stepper.step(state, tool_at({0.005, 0, 0.019 + model.contact_radius[0] - 5e-6 * i})).status,
              stepping::StepStatus::ok);
  EXPECT_EQ(state.position.x[0], model.rest_position.x[0]);
  EXPECT_LT(state.position.z[0], model.rest_position.z[0]);
}

INSTANTIATE_TEST_SUITE_P(Under, AContact,
                         ::testing::Values(Integrator::leapfrog, Integrator::backward_euler, Integrator::sdirk2));

/// Positions of a block's spheres while a ball presses one of them without friction. The ball touches from the start,
/// because a contact that begins within a step makes a kink in the force.
Vec3Array press(network::Structure structure, Integrator integrator, double tick) {
  network::Material material = testing::liver_material();
  material.stiffness_scale = 0.3;
  Model model = make_block_model(4, 4, 4, structure, material);
  model.contact_friction = 0, model.tools = {ball(0.004)}, model.tick = tick;
  testing::use_integrator(model, integrator), model.solver.tolerance = 1e-10, model.solver.velocity_floor = 1e-14;
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  const double touch = 0.012 * 3 + 0.004 + model.contact_radius.back(), duration = 0.016;
  const auto hand = [&](double time) {
    const double share = time / duration;
    return tool_at({0.0065, 0.0055, touch - 2e-4 - 0.001 * share * share * (3 - 2 * share)});
  };
  state.last_inputs = hand(0);
  while (double(state.tick) * tick < duration - 0.5 * tick)
    EXPECT_EQ(stepper.step(state, hand(double(state.tick + 1) * tick)).status, stepping::StepStatus::ok);
  return state.position;
}

double distance(const Vec3Array& a, const Vec3Array& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(sum);
}

class APress : public ::testing::TestWithParam<std::pair<Integrator, network::Structure>> {};

TEST_P(APress, IsOfSecondOrder) {
  const auto [integrator, structure] = GetParam();
  const Vec3Array reference = press(structure, integrator, 2.5e-5);
  const double coarse = distance(press(structure, integrator, 4e-4), reference),
               fine = distance(press(structure, integrator, 1e-4), reference);
  EXPECT_GT(fine, 0);
  EXPECT_GT(0.5 * std::log2(coarse / fine), 1.7) << coarse << " and " << fine << " m";
}

INSTANTIATE_TEST_SUITE_P(Of, APress,
                         ::testing::Values(std::pair{Integrator::leapfrog, network::Structure::mass_spring},
                                           std::pair{Integrator::sdirk2, network::Structure::ctpm}));

TEST(Contact, HasOneLawUnderEveryIntegrator) {
  // A ball hits a block at 100 mm/s and slides on it. With short steps all integrators must agree.
  const auto press = [](Integrator integrator) {
    network::Material material = testing::liver_material();
    material.viscosity = 5e3, material.stiffness_scale = 0.3;
    Model model = make_block_model(4, 4, 4, network::Structure::ctpm, material);
    model.tools = {ball(0.006)}, testing::use_integrator(model, integrator), model.solver.substeps = 16;
    State state = rest_state(model);
    stepping::Stepper stepper(model);
    const double touch = 0.036 + 0.006 + model.contact_radius.back();
    const auto hand = [&](double time) { return tool_at({0.007, 0.004 + 0.05 * time, touch - 0.1 * time}); };
    state.last_inputs = hand(0);
    while (state.tick < 60)
      EXPECT_EQ(stepper.step(state, hand(double(state.tick + 1) * model.tick)).status, stepping::StepStatus::ok);
    return state.position;
  };
  const Vec3Array reference = press(Integrator::sdirk2), rest = make_block_model(4, 4, 4).rest_position;
  const double moved = distance(reference, rest);
  EXPECT_LT(distance(press(Integrator::leapfrog), reference), 2e-3 * moved);
  EXPECT_LT(distance(press(Integrator::backward_euler), reference), 2e-2 * moved);
}

}  // namespace
}  // namespace ctpm
