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
  std::array<std::uint64_t, 4> hash;  ///< after 100, 200, 300 and 400 ticks
};

constexpr std::array<Golden, 4> kGolden{{
    {Structure::mass_spring,
     {0x9907705e43a29a84, 0xe047a5b938cb2e00, 0x73db2f1dd114fe82, 0xe4750373ef0154ef}},
    {Structure::angle_mass_spring,
     {0xe38f79220266f37b, 0x752b2d3285b3c061, 0x5b2b13de398fef3e, 0x61bdf2e7f6c3ab68}},
    {Structure::tpm, {0xc268a1c2c2e7ce3e, 0x82ae22fa35b78279, 0xb03349f427cd30e4, 0x4814db1a1177cdd4}},
    {Structure::ctpm, {0x43253179dc10312c, 0x586148d50f4888d8, 0x379315eff8d1ecee, 0x8d647da358105ee4}},
}};

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
    EXPECT_EQ(hash, golden.hash) << "structure " << int(golden.structure) << " gave " << actual;
  }
}

}  // namespace
}  // namespace ctpm
