// Tissue that was turned inside out comes back, under every integrator.

#include <gtest/gtest.h>

#include <string>

#include "core/elements/elements.h"
#include "core/inversion/resistance.h"
#include "core/stepping/step.h"
#include "tests/core/integrators.h"
#include "tests/core/inversion/cells.h"

namespace ctpm {
namespace {

using testing::cells_below;
using testing::farthest_from;
using testing::make_resisting_block;

/// A scene of one block, and what happened in it.
class Scene {
 public:
  explicit Scene(Model model, const stepping::StepperOptions& options = {})
      : model(std::move(model)), stepper(this->model, options), state(rest_state(this->model)) {
    stepper.settle(state, 3000);
    rest = state;
  }

  void tick(const Inputs& inputs = {}) {
    const stepping::StepReport report = stepper.step(state, inputs);
    EXPECT_FALSE(stepping::is_refused(report.status)) << int(report.status);
    inverted = report.inverted, most_inverted = std::max(most_inverted, inverted);
    EXPECT_EQ(std::size_t(inverted), cells_below(model, state.position, 0).size());
  }

  void wait(double seconds) {
    for (int i = 0; i < int(seconds * 1000); ++i) tick();
  }

  /// The largest distance from rest in the next second [m]: what vibrates counts too.
  double farthest_in_a_second() {
    double farthest = 0;
    for (int i = 0; i < 1000; ++i) tick(), farthest = std::max(farthest, farthest_from(rest, state));
    return farthest;
  }

  Model model;
  stepping::Stepper stepper;
  State state, rest;
  std::int32_t inverted = 0, most_inverted = 0;
};

/// A 72 x 72 x 48 mm block of liver on a fixed base under its weight, with a ball.
Model make_pressed_block(Integrator integrator, double ball_radius, double resistance = 10,
                         network::Structure structure = network::Structure::ctpm) {
  Model model = make_resisting_block(7, 7, 5, integrator, resistance, structure);
  model.gravity = {0, 0, -9.81};
  model.tools = {testing::ball(ball_radius)};
  return model;
}

constexpr double kTop = 0.048 + 0.006;  ///< of the block's surface above its base [m]

/// A ball of 20 mm presses 25 mm deep in 0.5 s, rests for 0.2 s and is gone.
void press(Scene& scene) {
  Inputs inputs;
  inputs.tool = 0;
  for (int i = 0; i < 700; ++i) {
    inputs.position = {0.001, 0.002, kTop + 0.02 - 0.025 * std::min(1.0, (i + 1) / 500.0)};
    scene.tick(inputs);
  }
}

/// A ball of 10 mm goes 20 mm deep beside the middle, and over the block at 100 mm/s.
void stroke(Scene& scene) {
  Inputs inputs;
  inputs.tool = 0;
  for (int i = 0; i < 1200; ++i) {
    inputs.position = {-0.05 + 1e-4 * std::max(0, i - 199), 0.002, kTop + 0.01 - 0.02 * std::min(1.0, (i + 1) / 200.0)};
    scene.tick(inputs);
  }
}

/// A ball of 20 mm is somewhere else in the block, or above it, every 10 ms for a second.
void teleport(Scene& scene) {
  testing::Noise noise;
  Inputs inputs;
  inputs.tool = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 at = noise.next_vec3();
    if (i % 10 == 0) inputs.position = {0.04 * at.x, 0.04 * at.y, 0.03 + 0.035 * at.z};
    scene.tick(inputs);
  }
}

class ResistanceUnder : public ::testing::TestWithParam<Integrator> {};

TEST_P(ResistanceUnder, TurnsASingleCellRightSideOut) {
  Scene scene(make_resisting_block(2, 2, 2, GetParam()));
  for (double& z : scene.state.position.z) z = -z;
  ASSERT_EQ(cells_below(scene.model, scene.state.position, 0).size(), 1u);
  scene.wait(2);
  EXPECT_EQ(scene.inverted, 0);
  EXPECT_LT(scene.farthest_in_a_second(), 2e-3);

  // Without resistance the mirror image is as much at rest as the block.
  Scene without(make_resisting_block(2, 2, 2, GetParam(), 0));
  for (double& z : without.state.position.z) z = -z;
  for (int i = 0; i < 1000; ++i) without.stepper.step(without.state, {});
  EXPECT_GT(farthest_from(without.rest, without.state), 0.02);
}

// The way back may end in a fold that is no cell's inversion; see core/README.md.
TEST_P(ResistanceUnder, LeavesNoCellOfABlockInsideOut) {
  Scene scene(make_resisting_block(5, 5, 4, GetParam()));
  for (double& z : scene.state.position.z) z = -z;
  scene.wait(2);
  EXPECT_EQ(scene.most_inverted, 48);
  EXPECT_EQ(scene.inverted, 0);
}

TEST_P(ResistanceUnder, ComesBackFromAPress) {
  Scene scene(make_pressed_block(GetParam(), 0.02));
  press(scene);
  EXPECT_EQ(scene.most_inverted, 0);
  scene.wait(4);
  EXPECT_EQ(scene.inverted, 0);
  EXPECT_LT(farthest_from(scene.rest, scene.state), 0.5e-3);
}

TEST_P(ResistanceUnder, ComesBackFromAStroke) {
  Scene scene(make_pressed_block(GetParam(), 0.01));
  stroke(scene);
  scene.wait(4);
  EXPECT_EQ(scene.inverted, 0);
  EXPECT_LT(farthest_from(scene.rest, scene.state), 0.5e-3);
}

TEST_P(ResistanceUnder, ComesBackFromAToolThatJumps) {
  Scene scene(make_pressed_block(GetParam(), 0.02));
  teleport(scene);
  // Leapfrog has no damping but that of the dashpots, so the block vibrates for longer.
  scene.wait(GetParam() == Integrator::leapfrog ? 10 : 4);
  EXPECT_EQ(scene.inverted, 0);
  EXPECT_LT(farthest_from(scene.rest, scene.state), 0.5e-3);
}

TEST_P(ResistanceUnder, ComesBackFromFiftyTimesItsWeight) {
  Scene scene(make_pressed_block(GetParam(), 0.02));
  scene.model.gravity = {0, 0, -50 * 9.81};
  scene.wait(2);
  EXPECT_GT(farthest_from(scene.rest, scene.state), 0.02);
  scene.model.gravity = {0, 0, -9.81};
  scene.wait(4);
  EXPECT_EQ(scene.inverted, 0);
  EXPECT_LT(farthest_from(scene.rest, scene.state), 0.5e-3);
}

CTPM_UNDER_EACH_INTEGRATOR(ResistanceUnder);

// The witness that the tests above need the resistance.
TEST(WithoutResistance, APressLeavesTissueInsideOut) {
  const auto off_after_press = [](double resistance) {
    Scene scene(make_pressed_block(Integrator::backward_euler, 0.02, resistance, network::Structure::mass_spring));
    Inputs inputs;
    inputs.tool = 0;
    for (int i = 0; i < 4700; ++i) {
      inputs.position = {0.001, 0.002, kTop + 0.02 - 0.025 * std::min(1.0, (i + 1) / 500.0)};
      scene.stepper.step(scene.state, i < 700 ? inputs : Inputs{});
    }
    return farthest_from(scene.rest, scene.state);
  };
  EXPECT_GT(off_after_press(0), 0.01);
  EXPECT_LT(off_after_press(10), 0.5e-3);
}

TEST(Leapfrog, KeepsMomentumAndAngularMomentumWhileCellsTurnOver) {
  Model model = make_resisting_block(6, 5, 5, Integrator::leapfrog);
  std::fill(model.held_axes.begin(), model.held_axes.end(), std::uint8_t(0));
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  testing::shake(state, 7e-3, 0.1);
  const auto momenta = [&] {
    std::pair<Vec3, Vec3> sum;
    for (std::size_t i = 0; i < model.sphere_count(); ++i) {
      const Vec3 p = model.mass[i] * state.velocity[i];
      sum.first += p, sum.second += cross(state.position[i], p);
    }
    return sum;
  };
  const auto before = momenta();
  std::int32_t most = 0;
  for (int i = 0; i < 300; ++i) most = std::max(most, stepper.step(state, {}).inverted);
  EXPECT_GT(most, 10);
  const auto after = momenta();
  EXPECT_LT(norm(after.first - before.first), 1e-12);
  EXPECT_LT(norm(after.second - before.second), 1e-12);
}

TEST(Leapfrog, HoldsAtItsLongestStepHoweverStiffTheResistance) {
  for (const double resistance : {10.0, 1000.0}) {
    network::Material material = testing::liver_material();
    material.viscosity = 0;
    Model model = testing::make_block_model(6, 6, 5, network::Structure::mass_spring, material, 0.012, resistance);
    testing::use_integrator(model, Integrator::leapfrog);
    model.tick = 0.99 * stepping::stable_step_bound(model);
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    testing::shake(state, 8e-3);
    std::int32_t first = 0;
    double fastest_at_first = 0, fastest_at_last = 0;
    for (int i = 0; i < 5000; ++i) {
      const stepping::StepReport report = stepper.step(state, {});
      ASSERT_EQ(report.status, stepping::StepStatus::ok) << resistance << ", tick " << i;
      if (i == 0) first = report.inverted;
      double& fastest = i < 100 ? fastest_at_first : fastest_at_last;
      if (i < 100 || i >= 4900) fastest = std::max(fastest, norm(state.velocity[std::size_t(report.worst_sphere)]));
    }
    EXPECT_GT(first, 10) << resistance;
    // Nothing damps it, so it vibrates for ever; but it gains no energy.
    EXPECT_LT(fastest_at_last, fastest_at_first) << resistance;
  }
}

// Pins.

TEST_P(ResistanceUnder, KeepsAPinnedSphereInTheHandAndGivesItTheForce) {
  Model model = make_resisting_block(3, 3, 2, GetParam());
  model.tools = {{"pin", ToolKind::pin, 0, 0, 13}};  // the middle of the upper face
  const Vec3 at = model.rest_position[13];
  const auto force_on_hand = [&](double resistance) {
    Model pressed = model;
    if (resistance == 0) pressed.tissue_cells = {};
    stepping::Stepper stepper(pressed);
    State state = rest_state(pressed);
    Inputs inputs;
    inputs.tool = 0;
    Vec3 force;
    for (int i = 0; i < 4000; ++i) {
      inputs.position = at - Vec3{0, 0, 0.011 * std::min(1.0, i / 1000.0)};  // to 1 mm above the anchored sphere below
      force = stepper.step(state, inputs).tool_force;
    }
    EXPECT_LT(norm(state.position[13] - inputs.position), 1e-12);
    // At rest the hand bears what acts on the sphere: elements and resistance.
    parallel::Team team(1);
    const parallel::Slabs slabs(pressed.sphere_count());
    const elements::Kernels& kernels = elements::kernels_for(elements::best_instruction_set());
    inversion::Resistance own(pressed, slabs, team, kernels);
    const std::size_t n = pressed.sphere_count();
    elements::Coordinates balance(3 * n);
    elements::DiagonalBlocks blocks(6 * n);
    elements::Elements(pressed, team).add_forces(state, balance);
    const auto linearised = own.linearise(state, 0, balance, blocks);
    const Vec3 expected{balance[13], balance[n + 13], balance[2 * n + 13]};
    EXPECT_LT(norm(force - expected), 0.02 * norm(expected)) << resistance;
    return force.z;
  };
  EXPECT_GT(force_on_hand(10), 1.5 * force_on_hand(0));
}

// Determinism.

State run_jumping_tool(Integrator integrator, const stepping::StepperOptions& options) {
  Model model = make_resisting_block(13, 12, 12, integrator);
  model.gravity = {0, 0, -9.81};
  model.tools = {testing::ball(0.03), testing::scalpel(0.1)};
  stepping::Stepper stepper(model, options);
  State state = rest_state(model);
  testing::Noise noise;
  std::int32_t inverted = 0, severed = 0;
  for (int tick = 0; tick < 40; ++tick) {
    Inputs inputs;
    const Vec3 at = noise.next_vec3();
    inputs.tool = tick < 25 ? 0 : 1;
    inputs.position =
        tick < 25 ? Vec3{0.03 * at.x, 0.03 * at.y, 0.10 + 0.03 * at.z} : Vec3{0.0007, -0.1 + 0.008 * (tick - 25), 0.06};
    const stepping::StepReport report = stepper.step(state, inputs);
    EXPECT_FALSE(stepping::is_refused(report.status));
    inverted += report.inverted, severed += report.severed;
  }
  EXPECT_GT(inverted, 0);
  EXPECT_GT(severed, 0);
  return state;
}

TEST_P(ResistanceUnder, GivesTheSameBitsOnEveryMachine) {
  const State plain = run_jumping_tool(GetParam(), {1, elements::InstructionSet::baseline});
  for (const int threads : {1, 2, 4})
    for (const elements::InstructionSet set :
         {elements::InstructionSet::baseline, elements::InstructionSet::avx2, elements::InstructionSet::avx512}) {
      const State other = run_jumping_tool(GetParam(), {threads, set});
      EXPECT_EQ(plain.position, other.position) << threads << " threads, " << elements::name_of(set);
      EXPECT_EQ(plain.velocity, other.velocity) << threads << " threads, " << elements::name_of(set);
    }
}

TEST_P(ResistanceUnder, GoesOnFromAnyState) {
  Model model = make_pressed_block(GetParam(), 0.02);
  model.tools.push_back(testing::scalpel(0.06));
  const auto inputs_at = [](int tick) {
    Inputs inputs;
    inputs.tool = tick < 60 ? 0 : 1;
    inputs.position =
        tick < 60 ? Vec3{0.001, 0.002, 0.06 - 0.0005 * tick} : Vec3{0.0007, -0.05 + 0.002 * (tick - 60), 0.02};
    return inputs;
  };
  stepping::Stepper one(model);
  State state = rest_state(model), keyframe;
  for (int tick = 0; tick < 120; ++tick) {
    if (tick == 90) keyframe = state;
    one.step(state, inputs_at(tick));
  }
  stepping::Stepper fresh(model);
  for (int tick = 90; tick < 120; ++tick) fresh.step(keyframe, inputs_at(tick));
  EXPECT_EQ(state.position, keyframe.position);
  EXPECT_EQ(state.velocity, keyframe.velocity);
}

}  // namespace
}  // namespace ctpm
