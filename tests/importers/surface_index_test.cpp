#include "importers/surface_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace ctpm {
namespace {

// Both sides work in doubles on lengths of about one.
constexpr double kRounding = 1e-12;

struct Heap {
  std::vector<Vec3> vertex;
  std::vector<importers::Triangle> triangle;
};

/// Triangles of all sizes in a box, among them needles, points and equal ones.
Heap heap_of_triangles(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<double> anywhere(-1, 1);
  const auto point = [&] { return Vec3{anywhere(random), anywhere(random), anywhere(random)}; };
  Heap heap;
  for (std::size_t t = 0; t < count; ++t) {
    const double size = std::pow(10.0, -4 * std::abs(anywhere(random)));
    const Vec3 a = point(), b = a + size * point();
    Vec3 c = a + size * point();
    if (t % 7 == 1) c = a + 0.3 * (b - a);
    if (t % 11 == 2) c = b;
    const std::int32_t n = std::int32_t(heap.vertex.size());
    heap.vertex.insert(heap.vertex.end(), {a, b, t % 13 == 3 ? a : c});
    heap.triangle.push_back({n, n + 1, n + 2});
    if (t % 5 == 4) heap.triangle.push_back(heap.triangle.back());
  }
  return heap;
}

double distance_one_by_one(const Heap& heap, Vec3 p) {
  double least = std::numeric_limits<double>::infinity();
  for (const importers::Triangle& t : heap.triangle)
    least =
        std::min(least, importers::squared_distance(p, heap.vertex[std::size_t(t[0])], heap.vertex[std::size_t(t[1])],
                                                    heap.vertex[std::size_t(t[2])]));
  return std::sqrt(least);
}

TEST(SurfaceIndex, FindsTheDistanceThatLookingAtEveryTriangleFinds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-1.5, 1.5);
  for (const std::size_t count : {1u, 2u, 4u, 5u, 9u, 16u, 17u, 33u, 300u, 2000u}) {
    const Heap heap = heap_of_triangles(count, random);
    const importers::SurfaceIndex index(heap.vertex, heap.triangle);
    std::int32_t guess = 0;
    for (int n = 0; n < 200; ++n) {
      const Vec3 p{anywhere(random), anywhere(random), anywhere(random)};
      const auto nearest = index.nearest(p, guess);
      guess = nearest.block;
      EXPECT_NEAR(std::sqrt(nearest.squared_distance), distance_one_by_one(heap, p), kRounding)
          << count << " triangles, point " << p.x << " " << p.y << " " << p.z;
    }
  }
}

TEST(SurfaceIndex, CornersAndEdgesAndPlaneOfATriangleAreAsFarAsGeometrySays) {
  const std::vector<Vec3> vertex{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  const importers::SurfaceIndex index(vertex, {{0, 1, 2}});
  const auto squared = [&](Vec3 p) { return index.nearest(p).squared_distance; };
  EXPECT_DOUBLE_EQ(squared({0.5, 0.5, 3}), 9);
  EXPECT_DOUBLE_EQ(squared({0.5, 0.5, -3}), 9);
  EXPECT_DOUBLE_EQ(squared({-3, -4, 0}), 25);
  EXPECT_DOUBLE_EQ(squared({1, -2, 1}), 5);
  EXPECT_DOUBLE_EQ(squared({2, 2, 0}), 2);
  EXPECT_DOUBLE_EQ(squared({0.5, 0.5, 0}), 0);
}

TEST(SurfaceIndex, GuessDoesNotChangeTheDistance) {
  std::mt19937 random(6);
  const Heap heap = heap_of_triangles(400, random);
  const importers::SurfaceIndex index(heap.vertex, heap.triangle);
  const double plain = index.nearest({0.1, 0.2, 0.3}).squared_distance;
  for (std::int32_t guess = 0; guess < 100; ++guess)
    EXPECT_EQ(index.nearest({0.1, 0.2, 0.3}, guess).squared_distance, plain);
}

}  // namespace
}  // namespace ctpm
