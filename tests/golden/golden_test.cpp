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
    {Structure::mass_spring, Integrator::automatic, {0x6183944f58d1f356, 0xb88de5c71b4d5175, 0x515087af93859efe, 0xbd8e44a9a5f658c4}},
    {Structure::angle_mass_spring, Integrator::automatic, {0x685a2b0f964dcd37, 0xf8921d183fc490fe, 0xd48e5d602fc6b35a, 0xedaf37813335933b}},
    {Structure::tpm, Integrator::automatic, {0x62aae1d6849a9ec6, 0xf317f7883353ce72, 0xfc9adb178e1e4476, 0x9813c21bee16acc0}},
    {Structure::ctpm, Integrator::automatic, {0x8f9ee5d58e8422e6, 0x5d57d9290932b106, 0xd1e300c2fd3c44cd, 0x3cffe265cebb7e40}},
    {Structure::tpm, Integrator::backward_euler, {0x182c447bd83e3e4e, 0xfa0e88d9cad44f55, 0xe545517443389a27, 0x382d67a9fc53c1a2}},
    {Structure::angle_mass_spring, Integrator::backward_euler, {0x3c8b3d942af056c2, 0xc547864fd8482918, 0x75096a7577d11f39, 0x53a02637280f9d40}},
    {Structure::ctpm, Integrator::extrapolated_euler, {0x3f8ccfdc6e03bda5, 0xa650076a680951ad, 0x3ccbca942db9b984, 0x9ec89f28bbc4153a}},
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
