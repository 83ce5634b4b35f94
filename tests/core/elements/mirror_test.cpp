// Every element law is symmetric under reflection: a reflected network moves as the reflection of the original.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "core/elements/forces.h"
#include "core/stepping/step.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

// Forces of a shaken liver block are about 1 N. Sign changes cause no rounding, so this is generous.
constexpr double kRounding = 1e-12;

/// A plane through the origin across one axis.
struct Mirror {
  int axis;

  Vec3 operator()(Vec3 p) const {
    if (axis == 0) return {-p.x, p.y, p.z};
    return axis == 1 ? Vec3{p.x, -p.y, p.z} : Vec3{p.x, p.y, -p.z};
  }
  void apply(Vec3Array& points) const {
    for (std::size_t i = 0; i < points.size(); ++i) points.set(i, (*this)(points[i]));
  }
};

/// The same elements between reflected spheres.
Model mirrored(Model model, Mirror mirror) {
  mirror.apply(model.rest_position), mirror.apply(model.loads.force);
  model.gravity = mirror(model.gravity);
  return model;
}

State mirrored(State state, Mirror mirror) {
  mirror.apply(state.position), mirror.apply(state.velocity);
  return state;
}

/// A State far from rest with stretched Kelvin units.
State shaken(const Model& model) {
  State state = rest_state(model);
  testing::shake(state, 0.004, 0.1);
  testing::Noise noise;
  for (double& z : state.kelvin_elongation) z = 0.001 * noise.next();
  return state;
}

class MirroredStructure : public ::testing::TestWithParam<network::Structure> {};

TEST_P(MirroredStructure, MirroredStateGivesMirroredForces) {
  const Model model = testing::make_block_model(6, 5, 4, GetParam());
  const State state = shaken(model);
  const Vec3Array force = elements::internal_forces(model, state);
  for (const Mirror mirror : {Mirror{0}, Mirror{1}, Mirror{2}}) {
    const Vec3Array got = elements::internal_forces(mirrored(model, mirror), mirrored(state, mirror));
    for (std::size_t i = 0; i < force.size(); ++i)
      ASSERT_NEAR(norm(got[i] - mirror(force[i])), 0, kRounding) << "axis " << mirror.axis << " sphere " << i;
  }
}

TEST_P(MirroredStructure, MirroredInputsGiveMirroredSteps) {
  Model model = testing::make_block_model(6, 5, 4, GetParam());
  model.tools = {testing::ball(0.006)};
  model.gravity = {1, 2, -9.81};
  model.loads.sphere = {100}, model.loads.force.push_back({0.02, -0.03, -0.05});
  model.loads.start = {0}, model.loads.ramp = {0.01};
  constexpr int kTicks = 30;
  const auto ball_at = [](int tick) { return Vec3{0.011 - 0.0001 * tick, 0.004, 0.048 - 0.0003 * tick}; };
  const auto run = [&](const Model& of, State state, const auto& place) {
    stepping::Stepper stepper(of);
    stepping::StepReport report;
    for (int tick = 0; tick < kTicks; ++tick) {
      Inputs inputs;
      inputs.tool = 0, inputs.position = place(ball_at(tick));
      report = stepper.step(state, inputs);
      EXPECT_EQ(report.status, stepping::StepStatus::ok);
    }
    return std::pair{state, report};
  };
  State begin = rest_state(model);
  testing::shake(begin, 0.001, 0.05);
  for (std::size_t i = 0; i < 30; ++i) begin.position.set(i, model.rest_position[i]), begin.velocity.set(i, {});
  const auto [state, report] = run(model, begin, [](Vec3 p) { return p; });
  ASSERT_GT(report.contacts, 0);
  for (const Mirror mirror : {Mirror{0}, Mirror{1}, Mirror{2}}) {
    const auto [got, got_report] = run(mirrored(model, mirror), mirrored(begin, mirror), mirror);
    EXPECT_NEAR(norm(got_report.tool_force - mirror(report.tool_force)), 0, 1e-9);
    for (std::size_t i = 0; i < model.sphere_count(); ++i)
      ASSERT_NEAR(norm(got.position[i] - mirror(state.position[i])), 0, kRounding)
          << "axis " << mirror.axis << " sphere " << i;
  }
}

// A run of four edges along x, A B C B A, is its own mirror image. So is the whole network of a block five spheres
// wide.
TEST_P(MirroredStructure, ABlockThatIsItsOwnMirrorImageIsPushedBackMirrored) {
  const std::array<int, 3> n{5, 4, 6};
  const Model model = testing::make_block_model(n[0], n[1], n[2], GetParam());
  const auto across = [&](std::size_t i) {
    const std::size_t x = i % std::size_t(n[0]);
    return i - x + (std::size_t(n[0]) - 1 - x);
  };
  const Mirror mirror{0};
  State state = rest_state(model), other = state;
  testing::shake(state, 0.004, 0.1);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    other.position.set(across(i), mirror(state.position[i])), other.velocity.set(across(i), mirror(state.velocity[i]));
  const Vec3Array force = elements::internal_forces(model, state),
                  other_force = elements::internal_forces(model, other);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    ASSERT_NEAR(norm(other_force[across(i)] - mirror(force[i])), 0, kRounding) << "sphere " << i;
}

INSTANTIATE_TEST_SUITE_P(Elements, MirroredStructure,
                         ::testing::Values(network::Structure::mass_spring, network::Structure::angle_mass_spring,
                                           network::Structure::tpm, network::Structure::ctpm));

}  // namespace
}  // namespace ctpm
