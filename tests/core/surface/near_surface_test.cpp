#include "core/surface/near_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/surface/surface.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

using surface::NearSurface;

std::set<std::array<std::int32_t, 3>> visited(NearSurface& near, const Vec3Array& position, Vec3 centre, double radius,
                                              double inside_of) {
  std::set<std::array<std::int32_t, 3>> found;
  near.begin(position);
  near.near(Box(centre).grown(radius), [&](const NearSurface::Triangle& t, const Vec3* corners) {
    for (int c = 0; c < 3; ++c)
      if (norm(corners[c] - centre) < inside_of) {
        found.insert({t.corner[0], t.corner[1], t.corner[2]});
        break;
      }
  });
  return found;
}

TEST(NearSurface, FindsEveryTriangleInABallHoweverTheSpheresMoved) {
  Model model = testing::make_skinned_block(5, 5, 4);
  State state = rest_state(model);
  testing::shake(state, 4e-3, 0);  // a third of a spacing
  NearSurface near(model, 0, 1);
  std::vector<Vec3> vertex;
  surface::deform_surface(model.surfaces[0], state.position, 0, vertex);
  for (const Vec3 centre : {Vec3{0, 0, 0.036}, Vec3{0.024, 0.024, 0.036}, Vec3{-0.03, 0.01, 0.01}, Vec3{0.2, 0, 0}})
    for (const double radius : {0.002, 0.008, 0.03}) {
      std::set<std::array<std::int32_t, 3>> wanted;
      for (const auto& t : model.surfaces[0].triangle)
        for (const std::int32_t v : t)
          if (norm(vertex[std::size_t(v)] - centre) < radius) wanted.insert(t);
      EXPECT_EQ(visited(near, state.position, centre, radius, radius), wanted) << radius;
    }
}

TEST(NearSurface, FindsEveryTriangleBehindAPlane) {
  const Model model = testing::make_skinned_block(5, 5, 4);
  State state = rest_state(model);
  testing::shake(state, 4e-3, 0);
  NearSurface near(model, 0, 1);
  std::vector<Vec3> vertex;
  surface::deform_surface(model.surfaces[0], state.position, 0, vertex);
  const surface::HalfSpace half{{0, 0, 0.03}, {0.6, 0, 0.8}};
  std::set<std::array<std::int32_t, 3>> wanted, found;
  for (const auto& t : model.surfaces[0].triangle)
    for (const std::int32_t v : t)
      if (dot(vertex[std::size_t(v)] - half.point, half.normal) < 0) wanted.insert(t);
  near.begin(state.position);
  near.near(half, [&](const NearSurface::Triangle& t, const Vec3* corners) {
    for (int c = 0; c < 3; ++c)
      if (dot(corners[c] - half.point, half.normal) < 0) found.insert({t.corner[0], t.corner[1], t.corner[2]});
  });
  EXPECT_GT(wanted.size(), 100u);
  EXPECT_LT(wanted.size(), model.surfaces[0].triangle.size());
  EXPECT_EQ(found, wanted);
}

TEST(NearSurface, OfAnOrganWithoutTrianglesIsEmptyInARoundToo) {
  Model model = testing::make_skinned_block(4, 4, 4);
  model.surfaces[0] = {};
  NearSurface near(model, 0, 1);
  EXPECT_TRUE(near.empty());
  near.begin(model.rest_position);
  near.near(Box(Vec3{}).grown(1), [](const NearSurface::Triangle&, const Vec3*) { FAIL() << "there are none"; });
}

TEST(NearSurface, HoldsOnlyTheOrgansThatItIsAskedFor) {
  const Model model = testing::make_skinned_block(4, 4, 4);
  EXPECT_TRUE(NearSurface(model, 0, 0).empty());
  EXPECT_FALSE(NearSurface(model, 0, 1).empty());
}

}  // namespace
}  // namespace ctpm
