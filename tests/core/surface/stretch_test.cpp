#include "core/surface/stretch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace ctpm {
namespace {

constexpr double kSpacing = 8e-3, kCell = kSpacing / 4;
constexpr int kLong = 61, kWide = 5;

/// A strip of cells, a quarter of a spacing wide each. One line of its places, in the middle, has two vertices each.
Surface strip() {
  Surface surface;
  const int middle = kLong / 2;
  for (int i = 0; i < kLong; ++i)
    for (int j = 0; j < kWide; ++j) surface.vertex.push_back({i * kCell, j * kCell, 0});
  for (int j = 0; j < kWide; ++j) surface.vertex.push_back({middle * kCell, j * kCell, 0});
  // The cells behind the middle begin at its second vertices.
  const auto at = [&](int i, int j, bool is_behind) {
    return std::int32_t(i == middle && is_behind ? kLong * kWide + j : i * kWide + j);
  };
  for (int i = 0; i + 1 < kLong; ++i)
    for (int j = 0; j + 1 < kWide; ++j) {
      const bool is_behind = i >= middle;
      const std::int32_t a = at(i, j, is_behind), b = at(i + 1, j, is_behind), c = at(i + 1, j + 1, is_behind),
                         d = at(i, j + 1, is_behind);
      surface.triangle.push_back({a, b, c}), surface.triangle.push_back({a, c, d});
    }
  return surface;
}

double most_stretch(const Surface& surface, const std::vector<Vec3>& vertex) {
  double most = 0;
  for (const auto& t : surface.triangle) {
    Vec3 rest[3], now[3];
    for (std::size_t c = 0; c < 3; ++c) rest[c] = surface.vertex[std::size_t(t[c])], now[c] = vertex[std::size_t(t[c])];
    most = std::max(most, surface::stretch_of(rest, now, kSpacing));
  }
  return most;
}

/// Half of the strip goes away from the other half by so many spacings, between two lines of places.
std::vector<Vec3> moved_apart(const Surface& surface, double spacings) {
  std::vector<Vec3> vertex = surface.vertex;
  for (std::size_t v = 0; v < vertex.size(); ++v)
    if (surface.vertex[v].x > (kLong / 2 - 0.5) * kCell) vertex[v] += spacings * kSpacing * Vec3{0.6, 0, 0.8};
  return vertex;
}

TEST(Stretch, IsThatOfTheLongestEdgeOrOfAShortLength) {
  const Vec3 rest[3] = {{0, 0, 0}, {kSpacing, 0, 0}, {0, kSpacing / 2, 0}};
  const Vec3 larger[3] = {{0, 0, 0}, {0, 3 * kSpacing, 0}, {1.5 * kSpacing, 0, 0}};
  EXPECT_DOUBLE_EQ(surface::stretch_of(rest, larger, kSpacing), 3);
  const Vec3 point[3] = {{0, 0, 0}, {1e-9, 0, 0}, {0, 1e-9, 0}};
  const Vec3 spread[3] = {{0, 0, 0}, {kSpacing, 0, 0}, {0, 0, 0}};
  EXPECT_DOUBLE_EQ(surface::stretch_of(point, spread, kSpacing), 1 / surface::kShort);
}

TEST(Stretch, ThatNoElementCarriesIsSpreadOverTheNeighbours) {
  const Surface surface = strip();
  for (const double spacings : {2.0, 4.0, 6.0}) {
    const std::vector<Vec3> carried = moved_apart(surface, spacings);
    std::vector<Vec3> vertex = carried;
    ASSERT_GT(most_stretch(surface, vertex), 1.1 * surface::kMostStretch);
    surface::spread_stretch(surface, kSpacing, vertex);
    EXPECT_LT(most_stretch(surface, vertex), 1.01 * surface::kMostStretch) << spacings << " spacings";
    for (std::size_t v = 0; v < vertex.size(); ++v)
      if (std::abs(surface.vertex[v].x - kLong / 2 * kCell) > 2.5 * kSpacing) {
        EXPECT_EQ(vertex[v], carried[v]) << "a place far away, " << v;
      }
  }
}

TEST(Stretch, LeavesPlacesTogetherThatAre) {
  const Surface surface = strip();
  std::vector<Vec3> vertex = moved_apart(surface, 4);
  surface::spread_stretch(surface, kSpacing, vertex);
  bool has_moved = false;
  for (int j = 0; j < kWide; ++j) {
    const auto one = std::size_t(kLong / 2 * kWide + j), other = std::size_t(kLong * kWide + j);
    EXPECT_EQ(vertex[one], vertex[other]) << j;
    has_moved = has_moved || vertex[one] != moved_apart(surface, 4)[one];
  }
  EXPECT_TRUE(has_moved);
}

TEST(Stretch, BelowTheMostIsLeftAsItIsToTheBit) {
  const Surface surface = strip();
  std::vector<Vec3> vertex;
  for (const Vec3& v : surface.vertex) vertex.push_back({4.5 * v.x + v.y, 0.3 * v.y, v.x});
  const std::vector<Vec3> before = vertex;
  ASSERT_LT(most_stretch(surface, vertex), surface::kMostStretch);
  surface::spread_stretch(surface, kSpacing, vertex);
  EXPECT_EQ(vertex, before);
}

}  // namespace
}  // namespace ctpm
