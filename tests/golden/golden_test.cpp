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
    {Structure::mass_spring,
     Integrator::automatic,
     {0x69e30ac3bd1ac37d, 0xce46bc4102e508b3, 0x79fdf055a0acd7bb, 0xd43b06cd3361466d}},
    {Structure::angle_mass_spring,
     Integrator::automatic,
     {0x1abd2210e9380a41, 0xd8f25bf5440cb7a3, 0xece31d1faec28a0a, 0x93cb2f6293aa25ce}},
    {Structure::tpm,
     Integrator::automatic,
     {0x09f48463866490a5, 0x0a6f151a19d7fc7f, 0xd6e4677e781d0d86, 0x9120df1aca025ccb}},
    {Structure::ctpm,
     Integrator::automatic,
     {0xbb124eda2f240214, 0xd368910b9482f88b, 0x72c5d443a0f10c36, 0x692b097ae9cbefe8}},
    {Structure::tpm,
     Integrator::backward_euler,
     {0xa96074b0379faad7, 0x968ca46685dd9aee, 0x9fb2298a133a8092, 0x65c1d447661e118b}},
    {Structure::angle_mass_spring,
     Integrator::backward_euler,
     {0xc763299e0bb6a373, 0xbc618d074c9b15e5, 0x1a4a398489d302ca, 0xc784a38daa1aa437}},
    {Structure::ctpm,
     Integrator::sdirk2,
     {0xab9834e13ef5e03a, 0x83d99c0f5e0da13c, 0x85d8915798f0e007, 0x0b5167087a7f4849}},
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
    EXPECT_EQ(run.hash, golden.hash) << "structure " << int(golden.structure) << ", " << name_of(golden.integrator)
                                     << " gave " << actual;
  }
}

}  // namespace
}  // namespace ctpm
