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
    {Structure::mass_spring, Integrator::automatic, {0x7c96b7993d60c022, 0xfcc4f6bea918f09f, 0xf283bf520b9f1e0a, 0xb0146e4b8ed3da18}},
    {Structure::angle_mass_spring, Integrator::automatic, {0xb18dbafb7d437b52, 0xf28faf555c5c158d, 0xcf079b7375057978, 0x64583bcc47b24d77}},
    {Structure::tpm, Integrator::automatic, {0xd347e40c40ff7148, 0xff44cab95faa28dc, 0x7a63ebabf794d050, 0x549fcb6ce29336cf}},
    {Structure::ctpm, Integrator::automatic, {0x3e90aa2e11c19b2e, 0xd83df21fd674c7b8, 0x948e0d1e93f7e6f5, 0x3b779fddf71defbe}},
    {Structure::tpm, Integrator::backward_euler, {0xd97a197b4c964605, 0xc64f7525b3e10cf3, 0x3443c0aca3e30f43, 0x1fde09adba296da2}},
    {Structure::angle_mass_spring, Integrator::backward_euler, {0xf5919dbdab53380b, 0x0e3c50109635f1c6, 0xda825766f8b4c1a0, 0xc93f3e1528470aae}},
    {Structure::ctpm, Integrator::sdirk2, {0xa69b9bccb276d109, 0x2ead0f2ddf41feb6, 0x947e356513d79098, 0x53c5f0a17c6acacc}},
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
