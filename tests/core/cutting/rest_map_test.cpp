// From places in the tissue at rest to where they are, and back.

#include "core/cutting/rest_map.h"

#include <gtest/gtest.h>

#include "tests/core/blocks.h"

namespace ctpm {
namespace {

using testing::make_block_model;

TEST(RestMap, AMoveGoesBackToRestThroughTheDeformation) {
  const Model model = make_block_model(5, 5, 5, network::Structure::ctpm);
  const cutting::RestMap map(model);
  cutting::Place place;
  map.find(0, {0.001, -0.002, 0.02}, 0.02, place);
  ASSERT_TRUE(place.spans_space);
  const auto stretched = [&](Vec3 by) {
    Vec3Array position(model.sphere_count());
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vec3 p = model.rest_position[i];
      position.set(i, {by.x * p.x, by.y * p.y, by.z * p.z});
    }
    return position;
  };
  const Vec3 rest = place.at_rest(stretched({0.5, 2, 1.25}), {1e-3, 1e-3, 1e-3});
  EXPECT_NEAR(rest.x, 2e-3, 1e-12);
  EXPECT_NEAR(rest.y, 0.5e-3, 1e-12);
  EXPECT_NEAR(rest.z, 0.8e-3, 1e-12);
  // Crushed to a hundredth along z, and stretched across so that the volume is still there.
  const Vec3 crushed = place.at_rest(stretched({10, 1, 0.01}), {0, 0, 1e-3});
  EXPECT_NEAR(norm(crushed), 20e-3, 1e-9) << "a hundred times as long would leave the tissue";
  EXPECT_NEAR(crushed.z, norm(crushed), 1e-9);
  EXPECT_EQ(norm(place.at_rest(stretched({1, 1, 0.01}), {0, 0, 1e-3})), 0) << "flat";
}

}  // namespace
}  // namespace ctpm
