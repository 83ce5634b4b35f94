// Threads and instruction sets that a Stepper uses must not change a bit of its results.

#include <gtest/gtest.h>

#include <string>

#include "core/parallel/slabs.h"
#include "core/parallel/team.h"
#include "core/stepping/step.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

using testing::ball;
using testing::make_block_model;
using testing::scalpel;

struct Machine {
  elements::InstructionSet set;
  int threads;
};

class EveryMachine : public ::testing::TestWithParam<Machine> {};

/// Large enough for several slabs; pressed, then cut.
Model make_model(network::Structure structure, Integrator integrator) {
  network::Material material = testing::liver_material();
  if (integrator == Integrator::leapfrog) material.viscosity = 5e3, material.stiffness_scale = 0.3;
  Model model = make_block_model(13, 12, 12, structure, material);
  model.gravity = {0, 0, -9.81};
  model.tools = {ball(0.02), scalpel(0.1)};
  testing::use_integrator(model, integrator);
  return model;
}

State run(const Model& model, const stepping::StepperOptions& options) {
  stepping::Stepper stepper(model, options);
  State state = rest_state(model);
  for (int tick = 0; tick < 24; ++tick) {
    Inputs inputs;
    inputs.tool = tick < 14 ? 0 : 1;
    inputs.position =
        tick < 14 ? Vec3{0.003, 0.001, 0.158 - 0.0005 * tick} : Vec3{0.0007, -0.1 + 0.008 * (tick - 14), 0.1};
    EXPECT_LE(stepper.step(state, inputs).status, stepping::StepStatus::not_converged);
  }
  return state;
}

TEST_P(EveryMachine, GivesTheSameBits) {
  const stepping::StepperOptions options{GetParam().threads, GetParam().set};
  for (const auto& [structure, integrator] :
       {std::pair{network::Structure::ctpm, Integrator::backward_euler},
        std::pair{network::Structure::ctpm, Integrator::leapfrog},
        std::pair{network::Structure::angle_mass_spring, Integrator::backward_euler},
        std::pair{network::Structure::tpm, Integrator::sdirk2}}) {
    const Model model = make_model(structure, integrator);
    const State plain = run(model, {1, elements::InstructionSet::baseline}), other = run(model, options);
    EXPECT_EQ(plain.position, other.position) << "structure " << int(structure);
    EXPECT_EQ(plain.velocity, other.velocity) << "structure " << int(structure);
    EXPECT_EQ(plain.kelvin_elongation, other.kelvin_elongation) << "structure " << int(structure);
    EXPECT_EQ(plain.acceleration, other.acceleration) << "structure " << int(structure);
    EXPECT_EQ(plain.axial_severed, other.axial_severed) << "structure " << int(structure);
    EXPECT_NE(plain.position, model.rest_position);
  }
}

TEST_P(EveryMachine, GivesTheSameBitsInManySlabs) {
  const Model model = make_block_model(26, 26, 26);
  ASSERT_EQ(parallel::Slabs(model.sphere_count()).count(), 4);
  const auto run = [&](const stepping::StepperOptions& options) {
    stepping::Stepper stepper(model, options);
    State state = rest_state(model);
    testing::shake(state, 1e-3, 0.01);
    for (int tick = 0; tick < 3; ++tick) EXPECT_FALSE(stepping::is_refused(stepper.step(state, {}).status));
    return state;
  };
  const State plain = run({1, elements::InstructionSet::baseline}), other = run({GetParam().threads, GetParam().set});
  EXPECT_EQ(plain.position, other.position);
  EXPECT_EQ(plain.velocity, other.velocity);
}

INSTANTIATE_TEST_SUITE_P(
    Machines, EveryMachine,
    ::testing::Values(Machine{elements::InstructionSet::baseline, 2}, Machine{elements::InstructionSet::baseline, 4},
                      Machine{elements::InstructionSet::avx2, 1}, Machine{elements::InstructionSet::avx2, 2},
                      Machine{elements::InstructionSet::avx512, 1}, Machine{elements::InstructionSet::avx512, 3}),
    [](const auto& of) {
      return std::string(elements::name_of(of.param.set)) + "With" + std::to_string(of.param.threads) + "Threads";
    });

TEST(Slabs, DependOnTheModelAlone) {
  EXPECT_EQ(parallel::Slabs(729).count(), 1);
  EXPECT_EQ(parallel::Slabs(5000).count(), 2);
  EXPECT_EQ(parallel::Slabs(30000).count(), 4);
  const parallel::Slabs many(100000);
  EXPECT_EQ(many.count() % 4, 0);
  for (std::int32_t sphere = 0; sphere < 100000; sphere += 997) {
    const int slab = many.of(sphere);
    EXPECT_LE(many.begin(slab), sphere);
    EXPECT_LT(sphere, many.end(slab));
  }
}

TEST(Team, DoesEveryTaskOnce) {
  for (const int threads : {1, 2, 5}) {
    parallel::Team team(threads);
    for (const int count : {0, 1, 2, 7, 64})
      for (int round = 0; round < 50; ++round) {
        std::vector<int> done(std::size_t(count), 0);
        team.for_each(count, [&](int i) { ++done[std::size_t(i)]; });
        EXPECT_EQ(done, std::vector<int>(std::size_t(count), 1));
      }
  }
}

}  // namespace
}  // namespace ctpm
