#include "core/cutting/tissue_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/cutting/blade_geometry.h"
#include "core/cutting/extent.h"
#include "core/model/result.h"

namespace ctpm::cutting {
namespace {

constexpr double kBucket = kSurfaceCell;  ///< half its diagonal is within the band [m]
/// Bounds of triangles are compared with distances that are longer by this factor.
constexpr double kRounding = 1 + 1e-6;

constexpr double kFar = std::numeric_limits<double>::infinity();

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

Vec3 TissueDepth::middle_of(const Grid& grid, std::size_t bucket) {
  const auto x = std::size_t(grid.extent[0]), y = std::size_t(grid.extent[1]);
  return grid.low +
         kBucket * Vec3{double(bucket % x) + 0.5, double(bucket / x % y) + 0.5, double(bucket / x / y) + 0.5};
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
  const auto& e = grid.extent;
  for (const auto& t : surface.triangle) grid.bound.push_back(bound_of(surface, t));
  for (std::size_t n = 0; n < grid.bound.size(); n += kBlock)
    grid.block.push_back(ball_around(&grid.bound[n], grid.bound.data() + std::min(n + kBlock, grid.bound.size())));
  const std::size_t count = std::size_t(e[0]) * std::size_t(e[1]) * std::size_t(e[2]);
  std::vector<std::pair<std::size_t, std::int32_t>> found;  // a bucket, and a triangle near it
  // At first the number of triangles near each bucket.
  grid.row.assign(count, 0);
  for (std::size_t n = 0; n < surface.triangle.size(); ++n) {
    const auto& t = surface.triangle[n];
    const Vec3 a = surface.vertex[std::size_t(t[0])], b = surface.vertex[std::size_t(t[1])],
               c = surface.vertex[std::size_t(t[2])], band{kBand, kBand, kBand};
    const Vec3 from = (least_of(least_of(a, b), c) - band - grid.low) / kBucket,
               to = (most_of(most_of(a, b), c) + band - grid.low) / kBucket;
    const double reach = kBand + 0.8661 * kBucket;
    for (auto k = std::int32_t(from.z); k <= std::min(std::int32_t(to.z), e[2] - 1); ++k)
      for (auto j = std::int32_t(from.y); j <= std::min(std::int32_t(to.y), e[1] - 1); ++j)
        for (auto i = std::int32_t(from.x); i <= std::min(std::int32_t(to.x), e[0] - 1); ++i) {
          const std::size_t bucket =
              std::size_t(i) + std::size_t(e[0]) * (std::size_t(j) + std::size_t(e[1]) * std::size_t(k));
          const Vec3 middle = middle_of(grid, bucket);
          if (grid.bound[n].is_beyond(middle, kRounding * reach)) continue;
          if (norm(nearest_in_triangle(middle, a, b, c) - middle) > reach) continue;
          found.emplace_back(bucket, std::int32_t(n)), ++grid.row[bucket];
        }
  }
  grid.first.assign(1, 0);
  for (std::int32_t& row : grid.row) {
    if (row > 0) grid.first.push_back(grid.first.back() + row);
    row = row > 0 ? std::int32_t(grid.first.size()) - 2 : -1;
  }
  grid.triangle.resize(found.size());
  std::vector<std::int32_t> next(grid.first.begin(), grid.first.end() - 1);
  for (const auto& [bucket, triangle] : found)
    grid.triangle[std::size_t(next[std::size_t(grid.row[bucket])]++)] = triangle;
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
