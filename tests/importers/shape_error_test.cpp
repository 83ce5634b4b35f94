// How far the spheres' outer boundary lies from the mesh's surface, against bodies of which that is known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "importers/fill.h"
#include "zoo.h"

namespace ctpm {
namespace {

importers::CheckedMesh checked(const importers::RawMesh& raw) {
  Result<importers::CheckedMesh> mesh = importers::repair_mesh(raw, 1, {});
  EXPECT_TRUE(mesh) << zoo::text_of(mesh.errors());
  return std::move(*mesh);
}

importers::Filling filled(const importers::CheckedMesh& mesh, double radius, double gap, int threads = 2) {
  importers::FillOptions options;
  options.sphere_radius = radius, options.gap = gap, options.threads = threads;
  Result<importers::Filling> filling = importers::fill_organ(mesh, options);
  EXPECT_TRUE(filling) << zoo::text_of(filling.errors());
  return std::move(*filling);
}

TEST(ShapeError, OfABoxIsTheRadiusOnItsFacesAndTheGapBetweenFourSpheres) {
  // A box of whole spacings has its outer spheres' centres on its faces: half of each stands out by r. The middle of
  // four of them is s / sqrt(2) from their centres.
  for (const int cuts : {1, 7})
    for (const double gap : {0.004, 0.010}) {
      const double r = 0.004, s = 2 * r + gap;
      const auto shape = filled(checked(zoo::box({10 * s, 8 * s, 6 * s}, cuts)), r, gap).report.shape;
      const double between = s / std::numbers::sqrt2 - r;
      EXPECT_NEAR(shape.largest, std::max(r, between), 0.02 * s) << cuts << " " << gap;
      EXPECT_LE(shape.largest, std::max(r, between) + 1e-9);
      if (gap == 0.004)
        EXPECT_NEAR(shape.p95, r, 1e-9);
      else  // outside a circle of radius q about each corner lies 5 % of a square with sides s, where q > s / 2
        for (double q = s / 2, h = s / 2;; q += 1e-6) {
          const double angle = std::acos(h / q);  // of the part of the circle that lies beyond the square
          const double inside = std::numbers::pi * q * q - 4 * (angle * q * q - h * std::sqrt(q * q - h * h));
          if (inside < 0.95 * s * s) continue;
          EXPECT_NEAR(shape.p95, q - r, 0.02 * s);
          break;
        }
    }
}

TEST(ShapeError, OfABallIsThatOfItsLattice) {
  // The distances of spheres and of the ball's own points are known from the centres alone.
  const double radius = 0.05;
  for (const double r : {0.005, 0.0025}) {
    const importers::Filling filling = filled(checked(zoo::sphere(radius, 5)), r, r);
    const FilledOrgan& organ = filling.organ;
    std::set<std::array<std::int32_t, 3>> cells(organ.cell.begin(), organ.cell.end());
    std::vector<std::pair<double, double>> spheres, points;  // distance, weight
    for (std::size_t n = 0; n < organ.cell.size(); ++n) {
      bool is_outer = false;
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          auto beside = organ.cell[n];
          beside[axis] += step;
          is_outer |= !cells.contains(beside);
        }
      if (is_outer) spheres.emplace_back(std::abs(norm(organ.centre[n]) + r - radius), organ.shares.sphere[n]);
    }
    constexpr int kPoints = 4000;  // on a spiral, evenly over the ball
    for (int i = 0; i < kPoints; ++i) {
      const double z = 1 - (2 * i + 1.0) / kPoints, turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
      const Vec3 at = radius * Vec3{std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
      double nearest = 1;
      for (const Vec3& centre : organ.centre) nearest = std::min(nearest, norm(centre - at));
      points.emplace_back(std::abs(nearest - r), 1);
    }
    const auto of = [](auto& values, double share) {
      std::sort(values.begin(), values.end());
      double whole = 0, sum = 0;
      for (const auto& [distance, weight] : values) whole += weight;
      for (const auto& [distance, weight] : values)
        if ((sum += weight) >= share * whole) return distance;
      return values.back().first;
    };
    const double within = 0.03 * organ.spacing;  // flat triangles, and points of either in other places
    EXPECT_NEAR(filling.report.shape.p95, std::max(of(spheres, 0.95), of(points, 0.95)), within) << r;
    EXPECT_NEAR(filling.report.shape.largest, std::max(of(spheres, 1), of(points, 1)), within) << r;
  }
}

TEST(ShapeError, IsHalfWithHalfTheRadiusAndTheSameForAnyMeshingAndThreads) {
  const importers::CheckedMesh fine = checked(zoo::torus(0.05, 0.02, 192, 96));
  const auto coarse_spheres = filled(fine, 0.004, 0.004).report.shape,
             fine_spheres = filled(fine, 0.002, 0.002).report.shape;
  EXPECT_NEAR(fine_spheres.p95 / coarse_spheres.p95, 0.5, 0.1);
  EXPECT_NEAR(fine_spheres.largest / coarse_spheres.largest, 0.5, 0.15);
  const auto one = filled(fine, 0.003, 0.003, 1).report.shape, four = filled(fine, 0.003, 0.003, 4).report.shape;
  EXPECT_EQ(one.p95, four.p95);
  EXPECT_EQ(one.largest, four.largest);
  const auto whole = filled(checked(zoo::box({0.1, 0.08, 0.07}, 1)), 0.004, 0.004).report.shape;
  const auto cut = filled(checked(zoo::box({0.1, 0.08, 0.07}, 40)), 0.004, 0.004).report.shape;
  EXPECT_NEAR(whole.p95, cut.p95, 0.02 * 0.012) << "few large triangles are measured as many small ones";
  EXPECT_NEAR(whole.largest, cut.largest, 0.05 * 0.012);
}

TEST(ShapeError, IsToldInWords) {
  EXPECT_EQ(importers::to_text(importers::ShapeError{0.0042, 0.00681}),
            "from the spheres' outer boundary to the surface: 95 % within 4.2 mm, all within 6.81 mm");
}

}  // namespace
}  // namespace ctpm
