#include "core/surface/surface.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ctpm {
namespace {

/// A block of n^3 spheres with a few surface points on and outside its faces.
FilledOrgan make_block(int n) {
  FilledOrgan organ;
  organ.sphere_radius = 0.004;
  organ.spacing = 0.012;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        organ.cell.push_back({i, j, k});
        organ.centre.push_back(organ.spacing * Vec3{double(i), double(j), double(k)});
      }
  const double edge = organ.spacing * (n - 0.5);
  organ.surface.vertex = {{0, 0, -0.006}, {edge, edge, edge}, {0.02, 0.01, edge}, {-0.006, 0.013, 0.017}};
  return organ;
}

TEST(SurfaceBinding, FollowsEveryAffineMotionExactly) {
  FilledOrgan organ = make_block(5);
  surface::bind_surface(organ);
  const auto motion = [](Vec3 p) {
    return Vec3{1.1 * p.x + 0.3 * p.y - 0.02, -0.4 * p.x + 0.9 * p.y + 0.2 * p.z + 0.5, 0.1 * p.y + 1.2 * p.z - 1};
  };
  Vec3Array moved;
  for (const Vec3& centre : organ.centre) moved.push_back(motion(centre));
  std::vector<Vec3> vertex;
  surface::deform_surface(organ.surface, moved, 0, vertex);
  for (std::size_t v = 0; v < vertex.size(); ++v)
    EXPECT_NEAR(norm(vertex[v] - motion(organ.surface.vertex[v])), 0, 1e-12) << "vertex " << v;  // only rounding errors
}

TEST(SurfaceBinding, WeightsSumToOneAlsoForOneSphereAndForAPlane) {
  for (int n : {1, 2, 3}) {
    FilledOrgan organ = make_block(n);
    if (n == 3) {  // a single layer of spheres is coplanar
      organ.centre.resize(9), organ.cell.resize(9);
    }
    surface::bind_surface(organ);
    for (std::size_t v = 0; v < organ.surface.vertex.size(); ++v) {
      double sum = 0;
      for (int e = organ.surface.binding.first[v]; e < organ.surface.binding.first[v + 1]; ++e)
        sum += organ.surface.binding.weight[std::size_t(e)];
      EXPECT_NEAR(sum, 1, 1e-12);
    }
  }
}

}  // namespace
}  // namespace ctpm
