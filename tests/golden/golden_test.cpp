// One small session, pressed and cut, against golden hashes. This file is built twice, with core optimised
// and not, and both programs must give the same bits; a change of the physics changes the hashes here,
// knowingly.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>

#include "tests/golden/session.h"

namespace ctpm {
namespace {

struct Golden {
  Structure structure;
  Integrator integrator;
  std::array<std::uint64_t, 4> hash;  ///< after 100, 200, 300 and 400 ticks
};

constexpr Golden kGolden[] = {
    {Structure::mass_spring, Integrator::automatic, {0xefee6ee3e3c82c33, 0xcb6ef3f14a3b1100, 0x7495e99c091d5c25, 0x35fb3c8ca2adad62}},
    {Structure::angle_mass_spring, Integrator::automatic, {0x5fe471d4eec34656, 0x4acd7e036ec4f538, 0x6bb9f230ce2f27aa, 0x6ef5bdddbafd6cf0}},
    {Structure::tpm, Integrator::automatic, {0x0d8961a1427bff72, 0x5b46da4ab226eaee, 0x14ad5411472d381a, 0xd3bdf3ac746f8969}},
    {Structure::ctpm, Integrator::automatic, {0x0f05f2cae2d5becb, 0xa08711354d919cb7, 0x2210cd74c42569f9, 0x207e28ddaffd20f9}},
    {Structure::tpm, Integrator::backward_euler, {0xd58c913a3e35caa8, 0x37c19f6b07503b9b, 0x813c582609345124, 0xd5a04ea8985977a6}},
    {Structure::angle_mass_spring, Integrator::backward_euler, {0x9b88eb6b869a77f3, 0x22825923ef28dec9, 0x7735b62b909da568, 0x20ea9837deaa3594}},
    {Structure::ctpm, Integrator::sdirk2, {0x2baaed97f1ff960d, 0x04d613eb611ff8f1, 0xf76240c4df9d0d5e, 0x750d056e83897034}},
};

TEST(Golden, ASmallSessionGivesTheSameBitsInEveryBuild) {
  for (const Golden& golden : kGolden) {
    const testing::GoldenRun run = testing::run_golden(6, 5, 5, 400, golden.structure, golden.integrator);
    EXPECT_TRUE(run.is_good);
    EXPECT_GT(run.severed, 0);
    EXPECT_GT(run.contacts, 0);
    char actual[128];
    std::snprintf(actual, sizeof actual, "{0x%016llx, 0x%016llx, 0x%016llx, 0x%016llx}",
                  (unsigned long long)run.hash[0], (unsigned long long)run.hash[1], (unsigned long long)run.hash[2],
                  (unsigned long long)run.hash[3]);
    EXPECT_EQ(run.hash, golden.hash) << "structure " << int(golden.structure) << ", " << name_of(golden.integrator) << " gave " << actual;
  }
}

}  // namespace
}  // namespace ctpm
