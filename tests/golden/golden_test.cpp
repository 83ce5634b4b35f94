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
    {Structure::mass_spring, Integrator::automatic, {0x9ecbfff087a726db, 0x2695dc2b34839dfe, 0xea028efb160903b7, 0x6fa319b59304f018}},
    {Structure::angle_mass_spring, Integrator::automatic, {0x200766316f785d65, 0xf59f93f12609fdaf, 0x4e22efbdf0bcdb92, 0x797ba80c49f59c54}},
    {Structure::tpm, Integrator::automatic, {0x3d241f525b19fef5, 0x82d052459cb01235, 0x13edb384703b3833, 0x82603d49f31697c8}},
    {Structure::ctpm, Integrator::automatic, {0xc44506146e8361ac, 0xe3b558cc999ce3a3, 0xdafa836395b50fec, 0xf36317961f699193}},
    {Structure::tpm, Integrator::backward_euler, {0x1691f751ab81ef95, 0xa888ab576848b857, 0xc6cba6c009078826, 0x9f16e4ac1e501c49}},
    {Structure::angle_mass_spring, Integrator::backward_euler, {0x1f35cc5560467d14, 0x541047df50a13e68, 0x2169798658f06bf6, 0x3d396a0836d35700}},
    {Structure::ctpm, Integrator::extrapolated_euler, {0xcb76cb1b726d4353, 0x0dc3605fab324f1a, 0xcf455bd96b1e44cd, 0xd6b173a7bfaa0a25}},
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
