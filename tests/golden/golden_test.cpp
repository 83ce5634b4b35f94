// One small session, pressed and cut, against golden hashes. This file is built twice, with core optimised
// and not, and both programs must give the same bits; a change of the physics changes the hashes here,
// knowingly.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>

#include "core/step.h"
#include "recordings/state_hash.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

struct Golden {
  Structure structure;
  Integrator integrator;
  std::array<std::uint64_t, 4> hash;  ///< after 100, 200, 300 and 400 ticks
};

constexpr Golden kGolden[] = {
    {Structure::mass_spring, Integrator::automatic, {0x898c77c0eec9e66c, 0xa5461c7bd03abb92, 0x8a2345de73fed2eb, 0x9285007be4e21652}},
    {Structure::angle_mass_spring, Integrator::automatic, {0x6bfcbc395e932cf0, 0x09b5cc7367191aa4, 0x4d7bad82552c6a76, 0x56026b32e9e8f9ec}},
    {Structure::tpm, Integrator::automatic, {0x0a083f2511d6c810, 0xcf3d5281d4212105, 0x221049b86b5aff95, 0x2cabddc669833de8}},
    {Structure::ctpm, Integrator::automatic, {0x43253179dc10312c, 0x586148d50f4888d8, 0x379315eff8d1ecee, 0x8d647da358105ee4}},
    {Structure::tpm, Integrator::backward_euler, {0xc268a1c2c2e7ce3e, 0x82ae22fa35b78279, 0xb03349f427cd30e4, 0x4814db1a1177cdd4}},
    {Structure::angle_mass_spring, Integrator::backward_euler, {0xe38f79220266f37b, 0x752b2d3285b3c061, 0x5b2b13de398fef3e, 0x61bdf2e7f6c3ab68}},
    {Structure::ctpm, Integrator::extrapolated_euler, {0x23fbf369ba1b334b, 0xe88d90ec569ae361, 0xa36c3c9ed87bdf27, 0x3332f1bb2e95db74}},
};

/// A ball presses for 200 ticks, then a scalpel goes through the block.
Inputs inputs_at(int tick) {
  Inputs inputs;
  if (tick < 200) {
    inputs.tool = 0;
    inputs.position = {0.001, -0.002, 0.048 + 0.012 - 0.00008 * tick};
  } else {
    inputs.tool = 1;
    inputs.position = {0.0007, -0.05 + 0.0005 * (tick - 200), 0.020};
  }
  return inputs;
}

TEST(Golden, ASmallSessionGivesTheSameBitsInEveryBuild) {
  for (const Golden& golden : kGolden) {
    Model model = testing::make_block_model(6, 5, 5, golden.structure);
    model.gravity = {0, 0, -9.81};
    model.solver.integrator = golden.integrator;
    model.tools = {testing::ball(0.006), testing::scalpel(0.06)};
    State state = rest_state(model);
    Stepper stepper(model);
    std::array<std::uint64_t, 4> hash{};
    std::int32_t severed = 0, contacts = 0;
    for (int tick = 0; tick < 400; ++tick) {
      const StepReport report = stepper.step(state, inputs_at(tick));
      ASSERT_EQ(report.status, StepStatus::ok);
      severed += report.severed, contacts += report.contacts;
      if ((tick + 1) % 100 == 0) hash[std::size_t(tick / 100)] = state_hash(state);
    }
    EXPECT_GT(severed, 0);
    EXPECT_GT(contacts, 0);
    char actual[128];
    std::snprintf(actual, sizeof actual, "{0x%016llx, 0x%016llx, 0x%016llx, 0x%016llx}",
                  (unsigned long long)hash[0], (unsigned long long)hash[1], (unsigned long long)hash[2],
                  (unsigned long long)hash[3]);
    EXPECT_EQ(hash, golden.hash) << "structure " << int(golden.structure) << ", " << name_of(golden.integrator) << " gave " << actual;
  }
}

}  // namespace
}  // namespace ctpm
