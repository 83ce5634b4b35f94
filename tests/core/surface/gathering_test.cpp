#include "core/surface/gathering.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

/// The surface of a block of 24 mm x 24 mm x 3 mm, of triangles with legs of `edge` [m].
Surface sheet(double edge) {
  FilledOrgan organ = testing::make_block(3, 3, 2);
  for (Vec3& centre : organ.centre) centre.z *= 0.25;
  testing::add_faces(organ, edge);
  return organ.surface;
}

TEST(Gathering, IsNearEachVertexAndOnItsSide) {
  const Surface fine = sheet(0.5e-3);
  const double radius = 1.5e-3;
  surface::Gathering gathering;
  gathering.add(fine, radius);
  const double middle = 0.5 * (fine.vertex.front().z + fine.vertex.back().z);
  std::size_t points = 0, members = 0;
  for (std::int32_t v = 0; v < std::int32_t(fine.vertex.size()); ++v) {
    const std::int32_t at = gathering.at(v);
    EXPECT_EQ(gathering.at(at), at) << v;
    EXPECT_LE(norm(fine.vertex[std::size_t(at)] - fine.vertex[std::size_t(v)]), 2 * radius) << v;
    const std::span<const std::int32_t> own = gathering.gathered_at(v);
    points += at == v, members += own.size();
    EXPECT_EQ(own.empty(), at != v) << v;
    EXPECT_TRUE(std::is_sorted(own.begin(), own.end())) << v;
    for (const std::int32_t member : own) EXPECT_EQ(gathering.at(member), v);
    const double height = fine.vertex[std::size_t(v)].z - middle;
    // The sides between the two faces may go with either.
    if (std::abs(height) > 1.4e-3) {
      EXPECT_GT(height * (fine.vertex[std::size_t(at)].z - middle), 0) << v;
    }
  }
  EXPECT_EQ(members, fine.vertex.size());
  EXPECT_LT(8 * points, fine.vertex.size());
}

TEST(Gathering, LeavesCoarseSurfacesAsTheyAreAndNumbersSurfacesOneAfterTheOther) {
  const Surface coarse = sheet(3e-3), fine = sheet(0.5e-3);
  surface::Gathering gathering, alone;
  gathering.add(coarse, 1.5e-3), gathering.add(fine, 1.5e-3), alone.add(fine, 1.5e-3);
  const auto before = std::int32_t(coarse.vertex.size());
  for (std::int32_t v = 0; v < before; ++v) EXPECT_EQ(gathering.at(v), v);
  for (std::int32_t v = 0; v < std::int32_t(fine.vertex.size()); ++v) {
    EXPECT_EQ(gathering.at(before + v), before + alone.at(v));
    EXPECT_EQ(gathering.gathered_at(before + v).size(), alone.gathered_at(v).size());
  }
}

}  // namespace
}  // namespace ctpm
