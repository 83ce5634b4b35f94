#include "core/cutting/tissue_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/cutting/blade_geometry.h"
#include "core/cutting/extent.h"
#include "core/model/result.h"

namespace ctpm::cutting {
namespace {

constexpr double kBucket = kSurfaceCell;  ///< half its diagonal is within the band [m]
/// Bounds of triangles are compared with distances that are longer by this factor.
constexpr double kRounding = 1 + 1e-6;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Of the buckets near a triangle, so many are remembered as bits.
constexpr std::size_t kBits = 64;

Vec3 least_of(Vec3 a, Vec3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 most_of(Vec3 a, Vec3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

}  // namespace

TissueDepth::TissueDepth(const Model& model, const RestMap& map, std::optional<std::size_t> only)
    : map_(map), grids_(model.organs.size()) {
  for (std::size_t o = 0; o < std::min(grids_.size(), model.surfaces.size()); ++o)
    if (only.value_or(o) == o && !model.surfaces[o].triangle.empty()) grids_[o] = make_grid(model.surfaces[o]);
}

std::int64_t TissueDepth::bucket_of(const Grid& grid, Vec3 rest) {
  const Vec3 at = (rest - grid.low) / kBucket;
  const auto& e = grid.extent;
  if (!(at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < e[0] && at.y < e[1] && at.z < e[2])) return -1;
  return std::int64_t(at.x) + e[0] * (std::int64_t(at.y) + e[1] * std::int64_t(at.z));
}

TissueDepth::Bound TissueDepth::bound_of(const Surface& surface, const std::array<std::int32_t, 3>& t) {
  const Vec3 a = surface.vertex[std::size_t(t[0])], b = surface.vertex[std::size_t(t[1])],
             c = surface.vertex[std::size_t(t[2])], middle = (a + b + c) / 3, normal = cross(b - a, c - a);
  return {middle, std::max({norm(a - middle), norm(b - middle), norm(c - middle)}), normal, dot(normal, normal)};
}

TissueDepth::Ball TissueDepth::ball_around(const Bound* begin, const Bound* end) {
  Vec3 low = begin->middle, high = low;
  for (const Bound* b = begin; b != end; ++b) low = least_of(low, b->middle), high = most_of(high, b->middle);
  Ball ball{0.5 * (low + high), 0};
  for (const Bound* b = begin; b != end; ++b)
    ball.radius = std::max(ball.radius, kRounding * (norm(b->middle - ball.middle) + b->radius));
  return ball;
}

Vec3 TissueDepth::middle_of(const Grid& grid, std::size_t i, std::size_t j, std::size_t k) {
  return grid.low + kBucket * Vec3{double(i) + 0.5, double(j) + 0.5, double(k) + 0.5};
}

Vec3 TissueDepth::middle_of(const Grid& grid, std::size_t bucket) {
  const auto x = std::size_t(grid.extent[0]), y = std::size_t(grid.extent[1]);
  return middle_of(grid, bucket % x, bucket / x % y, bucket / x / y);
}

/// Buckets from `from` to `to` that a triangle may come near to, numbered by their places, along x first.
struct TissueDepth::Window {
  std::array<std::int32_t, 3> from, to;

  bool fits_bits() const {
    std::size_t places = 1;
    for (std::size_t a = 0; a < 3; ++a) places *= std::size_t(to[a] - from[a] + 1);
    return places <= kBits;
  }
  /// Calls `visit(place, bucket, i, j, k)`.
  template <class Visit>
  void for_each(const std::array<std::int32_t, 3>& extent, const Visit& visit) const {
    std::size_t place = 0;
    for (std::int32_t k = from[2]; k <= to[2]; ++k)
      for (std::int32_t j = from[1]; j <= to[1]; ++j)
        for (std::int32_t i = from[0]; i <= to[0]; ++i, ++place)
          visit(place,
                std::size_t(i) + std::size_t(extent[0]) * (std::size_t(j) + std::size_t(extent[1]) * std::size_t(k)), i,
                j, k);
  }
};

TissueDepth::Window TissueDepth::window_of(const Grid& grid, std::size_t triangle) {
  const auto& t = grid.surface->triangle[triangle];
  const Vec3 a = grid.surface->vertex[std::size_t(t[0])], b = grid.surface->vertex[std::size_t(t[1])],
             c = grid.surface->vertex[std::size_t(t[2])], band{kBand, kBand, kBand};
  const Vec3 from = (least_of(least_of(a, b), c) - band - grid.low) / kBucket,
             to = (most_of(most_of(a, b), c) + band - grid.low) / kBucket;
  const auto& e = grid.extent;
  return {{std::int32_t(from.x), std::int32_t(from.y), std::int32_t(from.z)},
          {std::min(std::int32_t(to.x), e[0] - 1), std::min(std::int32_t(to.y), e[1] - 1),
           std::min(std::int32_t(to.z), e[2] - 1)}};
}

/// Calls `visit(place, bucket)` for the buckets of a window that a triangle comes within kBand of, at any place in
/// them.
template <class Visit>
void TissueDepth::for_each_near(const Grid& grid, std::size_t triangle, const Window& window, const Visit& visit) {
  constexpr double kReach = kBand + 0.8661 * kBucket, kSurely = kReach / kRounding;
  const Bound& bound = grid.bound[triangle];
  const auto& t = grid.surface->triangle[triangle];
  window.for_each(grid.extent, [&](std::size_t place, std::size_t bucket, std::int32_t i, std::int32_t j,
                                   std::int32_t k) {
    const Vec3 middle = middle_of(grid, std::size_t(i), std::size_t(j), std::size_t(k)), apart = middle - bound.middle;
    // Mostly the triangle's own middle shows that it is near.
    if (dot(apart, apart) > kSurely * kSurely) {
      if (bound.is_beyond(middle, kRounding * kReach)) return;
      const auto corner = [&](std::size_t c) { return grid.surface->vertex[std::size_t(t[c])]; };
      if (norm(nearest_in_triangle(middle, corner(0), corner(1), corner(2)) - middle) > kReach) return;
    }
    visit(place, bucket);
  });
}

/// Lists the triangles near each bucket, ascending.
void TissueDepth::find_near(Grid& grid) {
  const std::size_t count = grid.bound.size();
  const auto& e = grid.extent;
  // At first the number of triangles near each bucket.
  grid.row.assign(std::size_t(e[0]) * std::size_t(e[1]) * std::size_t(e[2]), 0);
  std::vector<std::uint64_t> is_near(count);  // a bit for each place of a triangle's window
  for (std::size_t n = 0; n < count; ++n)
    for_each_near(grid, n, window_of(grid, n), [&](std::size_t place, std::size_t bucket) {
      ++grid.row[bucket];
      is_near[n] |= std::uint64_t(1) << place % kBits;
    });
  grid.first.assign(1, 0);
  for (std::int32_t& row : grid.row) {
    if (row > 0) grid.first.push_back(grid.first.back() + row);
    row = row > 0 ? std::int32_t(grid.first.size()) - 2 : -1;
  }
  grid.triangle.resize(std::size_t(grid.first.back()));
  std::vector<std::int32_t> next(grid.first.begin(), grid.first.end() - 1);
  for (std::size_t n = 0; n < count; ++n) {
    const auto add = [&](std::size_t bucket) {
      grid.triangle[std::size_t(next[std::size_t(grid.row[bucket])]++)] = std::int32_t(n);
    };
    const Window window = window_of(grid, n);
    if (!window.fits_bits())
      for_each_near(grid, n, window, [&](std::size_t, std::size_t bucket) { add(bucket); });
    else
      window.for_each(e, [&](std::size_t place, std::size_t bucket, std::int32_t, std::int32_t, std::int32_t) {
        if (is_near[n] >> place & 1) add(bucket);
      });
  }
}

TissueDepth::Grid TissueDepth::make_grid(const Surface& surface) {
  Grid grid;
  grid.surface = &surface;
  Vec3 low = surface.vertex.front(), high = low;
  for (const Vec3& v : surface.vertex) low = least_of(low, v), high = most_of(high, v);
  const double margin = kBand + kBucket;
  grid.low = low - Vec3{margin, margin, margin};
  const Vec3 size = high - low + Vec3{2 * margin, 2 * margin, 2 * margin};
  grid.extent = {1 + std::int32_t(size.x / kBucket), 1 + std::int32_t(size.y / kBucket),
                 1 + std::int32_t(size.z / kBucket)};
  grid.bound.reserve(surface.triangle.size());
  for (const auto& t : surface.triangle) grid.bound.push_back(bound_of(surface, t));
  for (std::size_t n = 0; n < grid.bound.size(); n += kBlock)
    grid.block.push_back(ball_around(&grid.bound[n], grid.bound.data() + std::min(n + kBlock, grid.bound.size())));
  find_near(grid);
  find_sides(grid);
  return grid;
}

/// Sides of the buckets' middles: near ones from their triangles, the others from their neighbours.
void TissueDepth::find_sides(Grid& grid) {
  const auto& e = grid.extent;
  grid.side.assign(grid.row.size(), 0);
  std::vector<std::size_t> known, next;  // all of one distance: in an organ of decimetres there are many
  grid.near_middle.assign(grid.first.size() - 1, kFar);
  for (std::size_t b = 0; b < grid.row.size(); ++b) {
    if (grid.row[b] < 0) continue;
    const double depth = near(grid, b, middle_of(grid, b)).depth, distance = std::abs(depth);
    grid.near_middle[std::size_t(grid.row[b])] = distance;
    if (distance < kBand) grid.side[b] = depth > 0 ? 1 : -1;
    // A neighbour farther than the band from the surface is on the same side unless the surface passes close by.
    if (distance < kBand && distance > kBucket - kBand + 1e-4) known.push_back(b);
  }
  if (grid.side[0] == 0) grid.side[0] = -1, known.push_back(0);  // a corner of the grid is outside
  for (; !known.empty(); known.swap(next), next.clear())
    for (const std::size_t b : known) {
      const std::int32_t at[3] = {std::int32_t(b % std::size_t(e[0])),
                                  std::int32_t(b / std::size_t(e[0]) % std::size_t(e[1])),
                                  std::int32_t(b / std::size_t(e[0]) / std::size_t(e[1]))};
      const std::size_t step[3] = {1, std::size_t(e[0]), std::size_t(e[0]) * std::size_t(e[1])};
      for (std::size_t a = 0; a < 3; ++a)
        for (const bool up : {false, true}) {
          if (up ? at[a] + 1 >= e[a] : at[a] == 0) continue;
          const std::size_t other = up ? b + step[a] : b - step[a];
          if (grid.side[other] != 0) continue;
          grid.side[other] = grid.side[b], next.push_back(other);
        }
    }
}

/// Signed distance from the triangles of a bucket, and the nearest of them.
TissueDepth::Near TissueDepth::near(const Grid& grid, std::size_t bucket, Vec3 rest) {
  if (grid.row[bucket] < 0) return {kFar};
  const auto row = std::size_t(grid.row[bucket]);
  const Surface& surface = *grid.surface;
  double least2 = kFar, facing = 0;
  // The surface is no farther than by way of the bucket's middle.
  double farthest = kRounding * (grid.near_middle[row] + norm(rest - middle_of(grid, bucket)));
  std::int32_t nearest = -1;
  for (auto n = grid.first[row]; n < grid.first[row + 1]; ++n) {
    const auto index = std::size_t(grid.triangle[std::size_t(n)]);
    const Bound& bound = grid.bound[index];
    if (bound.is_beyond(rest, farthest)) continue;
    const auto& t = surface.triangle[index];
    const Vec3 a = surface.vertex[std::size_t(t[0])], b = surface.vertex[std::size_t(t[1])],
               c = surface.vertex[std::size_t(t[2])], normal = bound.normal;
    const Vec3 apart = rest - nearest_in_triangle(rest, a, b, c);
    const double distance2 = dot(apart, apart);
    // Where triangles share the nearest point, the one that the place lies most straight above decides the side.
    const double size = norm(normal), height = size > 0 ? dot(apart, normal) / size : 0.0;
    constexpr double kSame = 1e-9;
    const bool is_nearer = distance2 < least2 * (1 - kSame);
    if (!is_nearer && !(distance2 <= least2 * (1 + kSame) && std::abs(height) > std::abs(facing))) continue;
    if (is_nearer) least2 = distance2, farthest = std::min(farthest, kRounding * std::sqrt(distance2));
    facing = height, nearest = std::int32_t(index);
  }
  if (nearest < 0) return {kFar};
  return {facing > 0 ? -std::sqrt(least2) : std::sqrt(least2), nearest};
}

double TissueDepth::at(std::size_t organ, Vec3 rest) const {
  const Grid& grid = grids_[organ];
  if (grid.surface == nullptr) return std::clamp(map_.depth_in_cells(organ, rest), -kBand, kBand);
  const std::int64_t bucket = bucket_of(grid, rest);
  if (bucket < 0) return -kBand;
  const double depth = near(grid, std::size_t(bucket), rest).depth;
  return std::abs(depth) < kBand ? depth : grid.side[std::size_t(bucket)] * kBand;
}

Vec3 TissueDepth::nearest_on_surface(std::size_t organ, Vec3 rest) const {
  const Grid& grid = grids_[organ];
  CTPM_CHECK(grid.surface != nullptr, "an organ without a surface has no place on it");
  const Surface& surface = *grid.surface;
  // Blocks of triangles that are farther than what was found change nothing.
  const auto for_each_bound = [&](const double& farthest, const auto& visit) {
    for (std::size_t n = 0; n < grid.bound.size(); ++n) {
      const Ball& block = grid.block[n / kBlock];
      if (n % kBlock == 0 && norm(rest - block.middle) > kRounding * (farthest + block.radius))
        n += kBlock - 1;
      else
        visit(n);
    }
  };
  // A triangle's middle is a place on the surface.
  double farthest = kFar;
  for_each_bound(farthest, [&](std::size_t n) { farthest = std::min(farthest, norm(rest - grid.bound[n].middle)); });
  farthest *= kRounding;
  double least = kFar;
  Vec3 nearest = rest;
  for_each_bound(farthest, [&](std::size_t n) {
    if (grid.bound[n].is_beyond(rest, farthest)) return;
    const auto& t = surface.triangle[n];
    const Vec3 there = nearest_in_triangle(rest, surface.vertex[std::size_t(t[0])], surface.vertex[std::size_t(t[1])],
                                           surface.vertex[std::size_t(t[2])]);
    const double distance = norm(there - rest);
    if (distance < least) least = distance, nearest = there, farthest = std::min(farthest, kRounding * distance);
  });
  return nearest;
}

std::int32_t TissueDepth::nearest_triangle(std::size_t organ, Vec3 rest) const {
  const Grid& grid = grids_[organ];
  const std::int64_t bucket = grid.surface == nullptr ? -1 : bucket_of(grid, rest);
  return bucket < 0 ? -1 : near(grid, std::size_t(bucket), rest).triangle;
}

}  // namespace ctpm::cutting
