#include "core/stepping/integrator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/elements/forces.h"
#include "core/stepping/step.h"
#include "tests/core/blocks.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

using testing::liver_material;
using testing::make_block_model;
using testing::shake;

/// A block in which springs and dashpots are equally important at ticks of about 1 ms.
Model make_smooth_block(network::Structure structure, double tick, Integrator integrator) {
  network::Material material = liver_material();
  material.viscosity = 5e4;
  Model model = make_block_model(3, 3, 3, structure, material);
  model.tick = tick;
  testing::use_integrator(model, integrator);
  model.solver.tolerance = 1e-12;
  model.solver.velocity_floor = 1e-15;
  return model;
}

/// State of the block `duration` [s] after its release from a deformed shape.
State let_go(const Model& model, double duration) {
  State state = rest_state(model);
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 p = model.rest_position[i];
    if (model.held_axes[i] == 0) state.position.set(i, p + 0.05 * p.z * Vec3{1, 0.5, -0.3});
  }
  stepping::Stepper stepper(model);
  for (std::int64_t i = 0; i < std::llround(duration / model.tick); ++i)
    EXPECT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
  return state;
}

double distance(const State& a, const State& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    const Vec3 d = a.position[i] - b.position[i];
    sum += dot(d, d);
  }
  return std::sqrt(sum);
}

struct Order {
  Integrator integrator;
  network::Structure structure;
  double expected;
};

class IntegratorOrder : public ::testing::TestWithParam<Order> {};

TEST_P(IntegratorOrder, IsWhatItsNamePromises) {
  const Order order = GetParam();
  constexpr double kDuration = 0.016, kTick = 2e-4;
  const auto at = [&](double tick, Integrator integrator) {
    return let_go(make_smooth_block(order.structure, tick, integrator), kDuration);
  };
  const State reference = at(kTick / 64, Integrator::sdirk2);
  const double coarse = distance(at(kTick, order.integrator), reference),
               fine = distance(at(kTick / 2, order.integrator), reference);
  EXPECT_GT(fine, 0);
  EXPECT_NEAR(std::log2(coarse / fine), order.expected, 0.25) << coarse << " and " << fine << " m";
}

INSTANTIATE_TEST_SUITE_P(All, IntegratorOrder,
                         ::testing::Values(Order{Integrator::leapfrog, network::Structure::mass_spring, 2},
                                           Order{Integrator::leapfrog, network::Structure::tpm, 2},
                                           Order{Integrator::leapfrog, network::Structure::ctpm,
                                                 1},  // its dashpots use the old velocity
                                           Order{Integrator::backward_euler, network::Structure::mass_spring, 1},
                                           Order{Integrator::backward_euler, network::Structure::tpm, 1},
                                           Order{Integrator::backward_euler, network::Structure::ctpm, 1},
                                           Order{Integrator::sdirk2, network::Structure::mass_spring, 2},
                                           Order{Integrator::sdirk2, network::Structure::tpm, 2},
                                           Order{Integrator::sdirk2, network::Structure::ctpm, 2}));

class ImplicitIntegrator : public ::testing::TestWithParam<Integrator> {};

TEST_P(ImplicitIntegrator, IsLStable) {
  // A spring a million times too stiff for the tick: its deflection decays within a few ticks without ringing.
  network::Material material = liver_material();
  material.spring *= 1e6, material.kelvin *= 1e6, material.constraint *= 1e6, material.viscosity = 0;
  Model model = make_block_model(3, 3, 3, network::Structure::ctpm, material);
  testing::use_integrator(model, GetParam());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  shake(state, 1e-6);
  for (std::size_t i = 0; i < 9; ++i) state.position.set(i, model.rest_position[i]);
  const double first = distance(state, rest_state(model));
  for (int i = 0; i < 10; ++i) ASSERT_LE(stepper.step(state, {}).status, stepping::StepStatus::not_converged);
  EXPECT_LT(distance(state, rest_state(model)), 0.02 * first);
}

INSTANTIATE_TEST_SUITE_P(Both, ImplicitIntegrator, ::testing::Values(Integrator::backward_euler, Integrator::sdirk2));

/// Two free spheres and one spring; their angular frequency is sqrt(2 k / m).
Model make_pair() {
  Model model = make_block_model(2, 1, 1, network::Structure::mass_spring);
  model.held_axes.assign(2, 0);
  return model;
}

TEST(StableStepBound, IsExactForOneSpring) {
  const Model model = make_pair();
  const double frequency = std::sqrt(2 * model.axial.k[0] / model.mass[0]);
  EXPECT_NEAR(stepping::stable_step_bound(model), 2 / frequency, 1e-12);
}

TEST(StableStepBound, LeapfrogHoldsUpToIt) {
  for (const network::Structure structure :
       {network::Structure::mass_spring, network::Structure::tpm, network::Structure::ctpm}) {
    Model model = make_smooth_block(structure, 1e-3, Integrator::leapfrog);
    model.tick = 0.99 * stepping::stable_step_bound(model);
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    shake(state, 0.0005);
    for (std::size_t i = 0; i < 9; ++i) state.position.set(i, model.rest_position[i]);
    for (int i = 0; i < 5000; ++i) ASSERT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
    EXPECT_LT(distance(state, rest_state(model)), 0.05) << "structure " << int(structure);
  }
}

TEST(Leapfrog, RefusesStepsThatItCannotHoldAndLeavesTheState) {
  Model model = make_block_model(3, 3, 3);
  testing::use_integrator(model, Integrator::leapfrog);
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  EXPECT_EQ(stepper.step(state, {}).status, stepping::StepStatus::too_long);
  EXPECT_EQ(state.tick, 0);
  EXPECT_EQ(state.position, model.rest_position);
  EXPECT_FALSE(stepper.integrator().holds);
  EXPECT_NE(stepper.integrator().reason.find("ms"), std::string::npos);
}

/// A deformed block with random sphere velocities of up to `speed` [m/s], one tick after its release.
struct Released {
  State state;
  stepping::StepReport report;
};
Released after_a_tick(Integrator integrator, double speed) {
  Model model = make_smooth_block(network::Structure::tpm, 1e-3, integrator);
  State state = rest_state(model);
  shake(state, 1e-3, speed);
  for (std::size_t i = 0; i < 9; ++i) state.position.set(i, model.rest_position[i]), state.velocity.set(i, {});
  stepping::Stepper stepper(model);
  const stepping::StepReport report = stepper.step(state, {});
  EXPECT_EQ(report.status, stepping::StepStatus::ok);
  return {state, report};
}

TEST(Sdirk2, TakesBackwardEulerWhereItsStepIsTooLongForTheMotion) {
  // At 2 m/s the predictor moves too far. At 0.1 m/s it does not, but the velocity of every sphere changes within the
  // tick.
  for (const double speed : {2.0, 0.1}) {
    const Released by_sdirk = after_a_tick(Integrator::sdirk2, speed),
                   by_euler = after_a_tick(Integrator::backward_euler, speed);
    EXPECT_EQ(by_sdirk.state.position, by_euler.state.position) << speed;
    EXPECT_EQ(by_sdirk.state.velocity, by_euler.state.velocity) << speed;
    EXPECT_EQ(by_sdirk.state.kelvin_elongation, by_euler.state.kelvin_elongation) << speed;
    EXPECT_EQ(by_sdirk.report.fallbacks, 1) << speed;
    EXPECT_EQ(by_euler.report.fallbacks, 0) << speed;
  }
  EXPECT_NE(after_a_tick(Integrator::sdirk2, 0).state.position,
            rest_state(make_smooth_block(network::Structure::tpm, 1e-3, Integrator::sdirk2)).position);
}

TEST(Sdirk2, CountsTheStepsOfATickThatBackwardEulerTook) {
  Model model = make_smooth_block(network::Structure::tpm, 1e-3, Integrator::sdirk2);
  model.solver.substeps = 4;
  State state = rest_state(model);
  shake(state, 1e-3, 10.0);
  for (std::size_t i = 0; i < 9; ++i) state.position.set(i, model.rest_position[i]), state.velocity.set(i, {});
  stepping::Stepper stepper(model);
  const stepping::StepReport report = stepper.step(state, {});
  EXPECT_EQ(report.status, stepping::StepStatus::ok);
  EXPECT_GT(report.fallbacks, 1);
  EXPECT_LE(report.fallbacks, 4);
  state = rest_state(model);
  for (int tick = 0; tick < 3; ++tick) EXPECT_EQ(stepper.step(state, {}).fallbacks, 0) << "at rest, tick " << tick;
}

TEST(Sdirk2, NeedsNoBackwardEulerForWhatIsBelowTheErrorOfSolves) {
  // The predictor knows nothing of what the release of a deformed block sets off.
  const auto fallbacks = [](double deformation) {
    Model model = make_smooth_block(network::Structure::tpm, 1e-3, Integrator::sdirk2);
    model.solver.velocity_floor = 1e-6;
    State state = rest_state(model);
    shake(state, deformation);
    for (std::size_t i = 0; i < 9; ++i) state.position.set(i, model.rest_position[i]);
    return stepping::Stepper(model).step(state, {}).fallbacks;
  };
  EXPECT_EQ(fallbacks(3e-8), 0);
  EXPECT_EQ(fallbacks(3e-6), 1);
}

class VelocityEnough : public ::testing::TestWithParam<Integrator> {};

TEST_P(VelocityEnough, LeavesNoSlowMotionUndoneForEver) {
  // In a tick the block gets faster by less than is enough, and by more than the floor.
  // A stage of SDIRK2 is 0.29 of a tick.
  const double gravity = GetParam() == Integrator::sdirk2 ? 5e-3 : 1.5e-3, fallen = gravity * 0.5;  // [m/s^2], [m/s]
  const auto speed = [gravity](double floor, double enough) {
    network::Material soft = liver_material();
    soft.stiffness_scale = 1e-3;
    Model model = make_block_model(3, 3, 3, network::Structure::ctpm, soft);
    model.held_axes.assign(model.sphere_count(), 0);
    model.gravity = {0, 0, -gravity};
    testing::use_integrator(model, GetParam());
    model.solver.velocity_floor = floor, model.solver.velocity_enough = enough;
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    while (state.tick < 500) EXPECT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
    return -state.velocity.z[13];
  };
  EXPECT_NEAR(speed(1e-6, 2e-6), fallen, 0.05 * fallen);
  EXPECT_EQ(speed(2e-6, 0), 0) << "a floor that is as high does, so this is no idle test";
}

TEST_P(VelocityEnough, SavesIterationsOfAPressAndKeepsItsForce) {
  struct Press {
    double iterations = 0;
    std::vector<double> force;  // [N]
  };
  const auto press = [](double enough) {
    network::Material stiff = liver_material();
    stiff.stiffness_scale = 0.29;
    Model model = testing::make_skinned_block(9, 9, 9, network::Structure::ctpm, 0.006, stiff);
    model.tools = {testing::ball(0.006)};
    testing::use_integrator(model, GetParam());
    model.solver.velocity_enough = enough;
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    Press of;
    while (state.tick < 400) {
      Inputs inputs;
      inputs.tool = 0, inputs.position = {0.001, 0.002, 0.012 * 8 + 0.006 - 2e-5 * double(state.tick)};
      const stepping::StepReport report = stepper.step(state, inputs);
      EXPECT_EQ(report.status, stepping::StepStatus::ok);
      of.iterations += report.iterations, of.force.push_back(norm(report.tool_force));
    }
    return of;
  };
  const Press every = press(0), enough = press(2e-6);
  // Of SDIRK2 most solves need one iteration only.
  EXPECT_LT(enough.iterations, (GetParam() == Integrator::sdirk2 ? 0.99 : 0.8) * every.iterations);
  const double most = *std::max_element(every.force.begin(), every.force.end());
  for (std::size_t i = 0; i < every.force.size(); ++i) EXPECT_NEAR(enough.force[i], every.force[i], 5e-3 * most) << i;
  EXPECT_EQ(press(1e-7).force, every.force) << "less than the floor changes no bit";
}

INSTANTIATE_TEST_SUITE_P(Implicit, VelocityEnough, ::testing::Values(Integrator::backward_euler, Integrator::sdirk2),
                         [](const auto& info) {
                           return info.param == Integrator::sdirk2 ? "Sdirk2" : "BackwardEuler";
                         });

TEST(Leapfrog, ALoadThatStartsAtOnceIsOfSecondOrder) {
  const auto height = [](double tick) {
    Model model = make_block_model(2, 1, 1, network::Structure::mass_spring);
    model.held_axes = {kAnchored, 0}, model.tick = tick;
    testing::use_integrator(model, Integrator::leapfrog);
    model.loads.sphere = {1}, model.loads.force.push_back({0.02, 0, 0});
    model.loads.start = {0}, model.loads.ramp = {0};
    State state = rest_state(model);
    stepping::Stepper stepper(model);
    while (double(state.tick) * tick < 0.0159) EXPECT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
    const double k = model.axial.k[0], angle = std::sqrt(k / model.mass[1]) * 0.016;
    return state.position.x[1] - model.rest_position.x[1] - 0.02 / k * (1 - std::cos(angle));
  };
  EXPECT_NEAR(std::log2(height(4e-4) / height(2e-4)), 2, 0.1);
}

TEST(LossRate, IsThatOfFastMotion) {
  network::OrganSettings settings;
  settings.name = "pair", settings.structure = network::Structure::tpm, settings.material = liver_material();
  settings.tiling = network::Tiling::two_spheres;
  Model model;
  ASSERT_TRUE(bool(network::add_organ(model, testing::make_block(2, 1, 1), settings)));
  testing::use_integrator(model, Integrator::leapfrog);
  // Slow dashpots: many swings while they give way.
  const double k = model.axial.k[0], frequency = std::sqrt(2 * k / model.mass[0]);
  model.axial.c[0] = 60 * k / frequency, model.axial.kelvin_k[0] = k;
  model.tick = 0.02 / frequency;
  State state = rest_state(model);
  state.velocity.set(0, {0.01, 0, 0}), state.velocity.set(1, {-0.01, 0, 0});
  const auto energy = [&] {
    return elements::elastic_energy(model, state) +
           model.mass[0] * 0.5 *
               (dot(state.velocity[0], state.velocity[0]) + dot(state.velocity[1], state.velocity[1]));
  };
  stepping::Stepper stepper(model);
  const double before = energy();
  constexpr int kTicks = 3000;
  for (int i = 0; i < kTicks; ++i) ASSERT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
  const double rate = std::log(before / energy()) / (2 * kTicks * model.tick);
  EXPECT_NEAR(rate / stepping::loss_rate(model), 1, 0.03);
}

TEST(Automatic, IsExplicitWithoutStiffDashpotsAndImplicitWithThem) {
  network::Material material = liver_material();
  EXPECT_EQ(stepping::choose_integrator(make_block_model(4, 4, 4, network::Structure::ctpm, material)).integrator,
            Integrator::backward_euler);
  material.viscosity = 5e3;
  material.stiffness_scale = 0.3;
  const stepping::IntegratorChoice choice =
      stepping::choose_integrator(make_block_model(4, 4, 4, network::Structure::ctpm, material));
  EXPECT_EQ(choice.integrator, Integrator::leapfrog);
  EXPECT_GE(choice.substeps, 1);
  EXPECT_TRUE(choice.holds);
}

TEST(Automatic, TakesAsManySubstepsAsTheStiffestSphereNeeds) {
  Model model = make_pair();
  const double bound = stepping::stable_step_bound(model);
  model.tick = 0.5 * bound;
  EXPECT_EQ(stepping::choose_integrator(model).substeps, 1);
  model.tick = 1.7 * bound;
  EXPECT_EQ(stepping::choose_integrator(model).integrator, Integrator::leapfrog);
  EXPECT_EQ(stepping::choose_integrator(model).substeps, 2);
  model.tick = 2.5 * bound;
  EXPECT_EQ(stepping::choose_integrator(model).integrator, Integrator::sdirk2);
  EXPECT_EQ(stepping::choose_integrator(model).substeps, 1);
  model.tick = 100 * bound;
  EXPECT_EQ(stepping::choose_integrator(model).integrator, Integrator::backward_euler);
}

/// A block of tissue with the viscosity of the paper's Figs. 7 and 8, which damps next to nothing in a second, beside a
/// blade.
Model make_slow_block() {
  network::OrganSettings settings;
  settings.name = "slow", settings.structure = network::Structure::ctpm, settings.material = liver_material();
  settings.tiling = network::Tiling::two_spheres;
  for (int i = 0; i < 25; ++i) settings.anchored.push_back(i);
  Model model;
  EXPECT_TRUE(bool(network::add_organ(model, testing::make_block(5, 5, 5), settings)));
  model.tools = {testing::scalpel(0.06)};
  return model;
}

TEST(Automatic, DampsWhatACutLeavesSwinging) {
  network::Material material = liver_material();
  material.viscosity = 5e3, material.stiffness_scale = 0.3;
  Model model = make_block_model(4, 4, 4, network::Structure::ctpm, material);
  EXPECT_EQ(stepping::choose_integrator(model).integrator, Integrator::leapfrog);
  model.tools = {testing::scalpel(0.06)};
  EXPECT_EQ(stepping::choose_integrator(model).integrator, Integrator::sdirk2);
  Model slow = make_slow_block();
  ASSERT_LT(stepping::loss_rate(slow), 5);
  EXPECT_EQ(stepping::choose_integrator(slow).integrator, Integrator::backward_euler);
  slow.tools.clear();
  EXPECT_NE(stepping::choose_integrator(slow).integrator, Integrator::backward_euler);
}

TEST(Automatic, DampsWhatPrestrainSetsSwinging) {
  network::Material material = liver_material();
  material.viscosity = 5e3, material.stiffness_scale = 0.3, material.prestrain = 0.05;
  const stepping::IntegratorChoice choice =
      stepping::choose_integrator(make_block_model(4, 4, 4, network::Structure::ctpm, material));
  EXPECT_EQ(choice.integrator, Integrator::sdirk2);
  EXPECT_NE(choice.reason.find("tension at rest"), std::string::npos) << choice.reason;
}

/// Largest kinetic energy of a corner's sphere from 0.2 to 0.25 s after it was struck, as a part of what it got.
double part_that_swings(Model model) {
  State state = rest_state(model);
  const std::size_t corner = model.sphere_count() - 1;
  state.velocity.set(corner, {0.1, 0, 0.1});
  stepping::Stepper stepper(model);
  double most = 0;
  for (int tick = 0; tick < 250; ++tick) {
    EXPECT_EQ(stepper.step(state, {}).status, stepping::StepStatus::ok);
    if (tick >= 200) most = std::max(most, dot(state.velocity[corner], state.velocity[corner]) / 0.02);
  }
  return most;
}

TEST(Automatic, BesideABladeLightTissueComesToRest) {
  Model slow = make_slow_block();
  // As at an organ's boundary, where a sphere stands for a thousandth of a cell.
  constexpr double kLight = 1e-3;
  const auto corner = std::int32_t(slow.sphere_count()) - 1;
  slow.mass.back() *= kLight;
  for (std::size_t e = 0; e < slow.axial.size(); ++e)
    if (slow.axial.a[e] == corner || slow.axial.b[e] == corner)
      slow.axial.k[e] *= kLight, slow.axial.c[e] *= kLight, slow.axial.kelvin_k[e] *= kLight;
  const double needed = std::ceil(slow.tick / (0.9 * stepping::stable_step_bound(slow)));
  testing::use_integrator(slow, Integrator::leapfrog);
  slow.solver.substeps = std::int32_t(needed);
  EXPECT_GT(part_that_swings(slow), 0.1);
  slow.solver.substeps = 1;
  stepping::resolve_integrator(slow);
  EXPECT_LT(part_that_swings(slow), 1e-3);
}

}  // namespace
}  // namespace ctpm
