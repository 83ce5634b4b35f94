#include "importers/surface_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

#include "core/model/result.h"

namespace ctpm::importers {
namespace {

double coordinate(Vec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

double squared(Vec3 v) { return dot(v, v); }

/// Two doubles in one SIMD register; gives the same bits as scalar code.
using Pair = double __attribute__((vector_size(16)));
constexpr std::size_t kPair = 2;

Pair load(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}
Pair smaller(Pair a, Pair b) { return a < b ? a : b; }
Pair larger(Pair a, Pair b) { return a > b ? a : b; }

struct PairOfVec3 {
  Pair x, y, z;
};
PairOfVec3 operator-(const PairOfVec3& a, const PairOfVec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
PairOfVec3 operator*(Pair s, const PairOfVec3& a) { return {s * a.x, s * a.y, s * a.z}; }
Pair dot(const PairOfVec3& a, const PairOfVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
PairOfVec3 cross(const PairOfVec3& a, const PairOfVec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Squared distance from a point to a segment.
double squared_distance(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 ab = b - a, ap = p - a;
  const double length = dot(ab, ab);
  const double t = length > 0 ? std::clamp(dot(ap, ab) / length, 0.0, 1.0) : 0.0;
  return squared(ap - t * ab);
}

}  // namespace

double squared_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 normal = cross(b - a, c - a);
  const double area = dot(normal, normal);
  const auto is_inner_side = [&](Vec3 from, Vec3 to) { return dot(cross(to - from, p - from), normal) >= 0; };
  // If the point projects into the triangle, the plane is nearest, else an edge.
  if (area > 0 && is_inner_side(a, b) && is_inner_side(b, c) && is_inner_side(c, a)) {
    const double height = dot(p - a, normal);
    return height * height / area;
  }
  return std::min({squared_distance(p, a, b), squared_distance(p, b, c), squared_distance(p, c, a)});
}

/// Builds the tree top-down; each node halves its triangles twice, into four children.
struct SurfaceIndex::Builder {
  struct Range {
    std::int32_t begin, end;
    std::int32_t count() const { return end - begin; }
  };
  struct Boxes {
    Vec3 least, most;                ///< bounds of the triangles
    Vec3 middle_least, middle_most;  ///< bounds of their centres
  };

  SurfaceIndex& index;
  std::vector<std::array<Vec3, 3>> corners;
  std::vector<Vec3> middle;
  std::vector<std::int32_t> order;

  Boxes boxes_of(Range range) const {
    constexpr double kFar = std::numeric_limits<double>::max();
    const Vec3 far{kFar, kFar, kFar};
    Boxes boxes{far, -far, far, -far};
    const auto widen = [](Vec3& least, Vec3& most, Vec3 p) {
      least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
      most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    };
    for (std::int32_t n = range.begin; n < range.end; ++n) {
      const std::size_t t = std::size_t(order[std::size_t(n)]);
      for (const Vec3 p : corners[t]) widen(boxes.least, boxes.most, p);
      widen(boxes.middle_least, boxes.middle_most, middle[t]);
    }
    return boxes;
  }

  /// The disc of a range, with a margin so that rounding never makes it too small.
  Disc disc_of(Range range, Vec3 centre) const {
    constexpr double kMargin = 1e-12;
    Disc disc;
    Vec3 sum;
    for (std::int32_t n = range.begin; n < range.end; ++n) {
      const auto& [a, b, c] = corners[std::size_t(order[std::size_t(n)])];
      sum += cross(b - a, c - a);
    }
    disc.normal = norm(sum) > 0 && std::isfinite(1 / norm(sum)) ? sum / norm(sum) : Vec3{1, 0, 0};
    double low = 0, high = 0, squared_radius = 0;
    bool is_first = true;
    for (std::int32_t n = range.begin; n < range.end; ++n)
      for (const Vec3 p : corners[std::size_t(order[std::size_t(n)])]) {
        const Vec3 v = p - centre;
        const double height = dot(v, disc.normal);
        low = is_first ? height : std::min(low, height), high = is_first ? height : std::max(high, height);
        squared_radius = std::max(squared_radius, squared(v - height * disc.normal));
        is_first = false;
      }
    disc.centre = centre + 0.5 * (low + high) * disc.normal;
    const double size = std::sqrt(squared_radius) + std::max(std::abs(low), std::abs(high));
    // Moving the centre has a rounding error proportional to the coordinates.
    const double margin = kMargin * (size + norm(centre));
    disc.half_height = 0.5 * (high - low) + margin;
    disc.radius = std::sqrt(squared_radius) + margin;
    return disc;
  }

  /// Halves a range at the median along the longest extent of its triangle centres, in whole blocks.
  std::pair<Range, Range> halves(Range range) {
    const Boxes boxes = boxes_of(range);
    const Vec3 extent = boxes.middle_most - boxes.middle_least;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::int32_t blocks = (range.count() + kLanes - 1) / kLanes;
    const std::int32_t half = range.begin + blocks / 2 * kLanes;
    std::nth_element(order.begin() + range.begin, order.begin() + half, order.begin() + range.end,
                     [&](std::int32_t a, std::int32_t b) {
                       const double ma = coordinate(middle[std::size_t(a)], axis);
                       const double mb = coordinate(middle[std::size_t(b)], axis);
                       return ma != mb ? ma < mb : a < b;
                     });
    return {{range.begin, half}, {half, range.end}};
  }

  /// The child for a range: a node index, or ~ a block index.
  std::int32_t add(Range range) {
    if (range.count() <= kLanes) {
      index.blocks_.push_back(make_block(corners, order.data() + range.begin, range.count()));
      return ~std::int32_t(index.blocks_.size() - 1);
    }
    std::array<Range, kLanes> part{};
    std::size_t parts = 0;
    const auto [low, high] = halves(range);
    for (const Range half : {low, high}) {
      if (half.count() <= kLanes) {
        part[parts++] = half;
        continue;
      }
      const auto [first, second] = halves(half);
      part[parts++] = first, part[parts++] = second;
    }
    const std::size_t self = index.nodes_.size();
    index.nodes_.emplace_back();
    for (std::size_t n = 0; n < std::size_t(kLanes); ++n) {
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      Boxes boxes{{kInfinity, 0, 0}, {kInfinity, 0, 0}, {}, {}};
      if (n < parts) boxes = boxes_of(part[n]);
      const std::int32_t child = n < parts ? add(part[n]) : 0;
      Node& node = index.nodes_[self];
      if (n < parts) node.disc[n] = disc_of(part[n], 0.5 * (boxes.least + boxes.most));
      node.child[n] = child;
      node.least.x[n] = boxes.least.x, node.least.y[n] = boxes.least.y, node.least.z[n] = boxes.least.z;
      node.most.x[n] = boxes.most.x, node.most.y[n] = boxes.most.y, node.most.z[n] = boxes.most.z;
    }
    return std::int32_t(self);
  }
};

SurfaceIndex::SurfaceIndex(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle) {
  CTPM_CHECK(!triangle.empty(), "an index needs triangles");
  Builder builder{*this, {}, {}, {}};
  builder.corners.reserve(triangle.size());
  builder.middle.reserve(triangle.size());
  for (const Triangle& t : triangle) {
    const Vec3 a = vertex[std::size_t(t[0])], b = vertex[std::size_t(t[1])], c = vertex[std::size_t(t[2])];
    builder.corners.push_back({a, b, c});
    builder.middle.push_back((a + b + c) / 3);
  }
  builder.order.resize(triangle.size());
  std::iota(builder.order.begin(), builder.order.end(), 0);
  blocks_.reserve(triangle.size() / kLanes + 1);
  nodes_.reserve(triangle.size() / kLanes + 1);
  builder.add({0, std::int32_t(triangle.size())});
}

SurfaceIndex::Block SurfaceIndex::make_block(const std::vector<std::array<Vec3, 3>>& corners,
                                             const std::int32_t* triangle, std::int32_t count) {
  Block block{};
  const auto put = [](LanesOfVec3& lanes, std::size_t n, Vec3 p) {
    lanes.x[n] = p.x, lanes.y[n] = p.y, lanes.z[n] = p.z;
  };
  const auto inverse = [](double value) { return value > 0 && std::isfinite(1 / value) ? 1 / value : 0.0; };
  for (std::size_t n = 0; n < std::size_t(kLanes); ++n) {
    const auto& [a, b, c] = corners[std::size_t(triangle[std::min(std::int32_t(n), count - 1)])];
    put(block.a, n, a), put(block.b, n, b), put(block.c, n, c);
    const Vec3 normal = cross(b - a, c - a);
    put(block.normal, n, inverse(norm(normal)) * normal);
    block.inverse_ab[n] = inverse(squared(b - a));
    block.inverse_bc[n] = inverse(squared(c - b));
    block.inverse_ca[n] = inverse(squared(a - c));
  }
  return block;
}

/// squared_distance() for four triangles at once, without branches.
SurfaceIndex::Lanes SurfaceIndex::squared_distances(const Block& block, Vec3 point) {
  const Pair zero{0, 0}, one{1, 1};
  const PairOfVec3 p{point.x + zero, point.y + zero, point.z + zero};
  Lanes result;
  for (std::size_t n = 0; n < std::size_t(kLanes); n += kPair) {
    const auto at = [n](const LanesOfVec3& v) { return PairOfVec3{load(&v.x[n]), load(&v.y[n]), load(&v.z[n])}; };
    const PairOfVec3 a = at(block.a), b = at(block.b), c = at(block.c), normal = at(block.normal);
    const PairOfVec3 ab = b - a, bc = c - b, ca = a - c, ap = p - a, bp = p - b, cp = p - c;
    const auto to_edge = [&](const PairOfVec3& edge, const PairOfVec3& from_start, const Lanes& inverse) {
      const Pair share = smaller(larger(dot(from_start, edge) * load(&inverse[n]), zero), one);
      const PairOfVec3 rest = from_start - share * edge;
      return dot(rest, rest);
    };
    const Pair edge = smaller(smaller(to_edge(ab, ap, block.inverse_ab), to_edge(bc, bp, block.inverse_bc)),
                              to_edge(ca, cp, block.inverse_ca));
    // Inside all three edges the plane is nearest, except for a triangle without a normal.
    const Pair side =
        smaller(smaller(dot(cross(ab, ap), normal), dot(cross(bc, bp), normal)), dot(cross(ca, cp), normal));
    const Pair height = dot(ap, normal);
    const Pair squared_distance = side > zero ? height * height : edge;
    std::memcpy(&result[n], &squared_distance, sizeof squared_distance);
  }
  return result;
}

SurfaceIndex::Lanes SurfaceIndex::squared_distances(const Node& node, Vec3 point) {
  const Pair zero{0, 0};
  Lanes result;
  for (std::size_t n = 0; n < std::size_t(kLanes); n += kPair) {
    const auto along = [&](const Lanes& least, const Lanes& most, double p) {
      return larger(larger(load(&least[n]) - p, p - load(&most[n])), zero);
    };
    const Pair dx = along(node.least.x, node.most.x, point.x);
    const Pair dy = along(node.least.y, node.most.y, point.y);
    const Pair dz = along(node.least.z, node.most.z, point.z);
    const Pair squared_distance = dx * dx + dy * dy + dz * dz;
    std::memcpy(&result[n], &squared_distance, sizeof squared_distance);
  }
  return result;
}

double SurfaceIndex::squared_distance_from(const Disc& disc, Vec3 point) {
  const Vec3 v = point - disc.centre;
  const double height = dot(v, disc.normal);
  const double above = std::max(std::abs(height) - disc.half_height, 0.0);
  const double beside = std::max(std::sqrt(std::max(squared(v) - height * height, 0.0)) - disc.radius, 0.0);
  constexpr double kRounded = 1 - 1e-12;  // lower bound despite rounding
  return kRounded * (above * above + beside * beside);
}

SurfaceIndex::Nearest SurfaceIndex::nearest(Vec3 point, std::int32_t guess) const {
  CTPM_CHECK(guess >= 0 && std::size_t(guess) < blocks_.size(), "a guess comes from an earlier answer");
  Nearest best{std::numeric_limits<double>::infinity(), guess};
  const auto look_at_block = [&](std::int32_t block) {
    const Lanes distance = squared_distances(blocks_[std::size_t(block)], point);
    const double least = std::min({distance[0], distance[1], distance[2], distance[3]});
    if (least < best.squared_distance) best = {least, block};
  };
  look_at_block(guess);
  struct Waiting {
    std::int32_t child;
    double distance;
  };
  std::array<Waiting, 128> stack;  // at most three wait per level, and each level has a quarter of the triangles
  std::size_t height = 0;
  if (!nodes_.empty()) stack[height++] = {0, 0.0};
  while (height > 0) {
    const Waiting next = stack[--height];
    if (next.distance >= best.squared_distance) continue;
    if (next.child < 0) {
      look_at_block(~next.child);
      continue;
    }
    const Node& node = nodes_[std::size_t(next.child)];
    Lanes distance = squared_distances(node, point);
    const std::size_t first = height;
    for (std::size_t n = 0; n < std::size_t(kLanes); ++n) {
      if (!(distance[n] < best.squared_distance)) continue;
      distance[n] = std::max(distance[n], squared_distance_from(node.disc[n], point));
      if (!(distance[n] < best.squared_distance)) continue;
      // Pop the nearest child first.
      std::size_t place = height++;
      for (; place > first && stack[place - 1].distance < distance[n]; --place) stack[place] = stack[place - 1];
      stack[place] = {node.child[n], distance[n]};
    }
  }
  return best;
}

}  // namespace ctpm::importers
