#include "importers/surface_index.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "core/result.h"

namespace ctpm {
namespace {

constexpr std::int32_t kLeafSize = 4;

double coordinate(Vec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

double squared(Vec3 v) { return dot(v, v); }

/// Squared distance of a point from a segment.
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
  // Above the triangle the plane is nearest; anywhere else one of the edges is.
  if (area > 0 && is_inner_side(a, b) && is_inner_side(b, c) && is_inner_side(c, a)) {
    const double height = dot(p - a, normal);
    return height * height / area;
  }
  return std::min({squared_distance(p, a, b), squared_distance(p, b, c), squared_distance(p, c, a)});
}

SurfaceIndex::SurfaceIndex(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle) {
  CTPM_CHECK(!triangle.empty(), "an index needs triangles");
  std::vector<Corners> corners;
  std::vector<Vec3> middle;
  corners.reserve(triangle.size());
  middle.reserve(triangle.size());
  for (const Triangle& t : triangle) {
    corners.push_back({vertex[std::size_t(t[0])], vertex[std::size_t(t[1])], vertex[std::size_t(t[2])]});
    middle.push_back((corners.back().a + corners.back().b + corners.back().c) / 3);
  }
  std::vector<std::int32_t> order(triangle.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(triangle.size());
  triangles_.reserve(triangle.size());
  build(order, middle, 0, std::int32_t(order.size()), corners);
}

void SurfaceIndex::build(std::vector<std::int32_t>& order, const std::vector<Vec3>& middle,
                         std::int32_t begin, std::int32_t end, const std::vector<Corners>& corners) {
  constexpr double kFar = std::numeric_limits<double>::max();
  Node node{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}, 0, 0};
  double middle_least[3] = {kFar, kFar, kFar}, middle_most[3] = {-kFar, -kFar, -kFar};
  for (std::int32_t n = begin; n < end; ++n) {
    const Corners& t = corners[std::size_t(order[std::size_t(n)])];
    for (int axis = 0; axis < 3; ++axis) {
      for (const Vec3 p : {t.a, t.b, t.c}) {
        node.least[axis] = std::min(node.least[axis], coordinate(p, axis));
        node.most[axis] = std::max(node.most[axis], coordinate(p, axis));
      }
      const double m = coordinate(middle[std::size_t(order[std::size_t(n)])], axis);
      middle_least[axis] = std::min(middle_least[axis], m);
      middle_most[axis] = std::max(middle_most[axis], m);
    }
  }
  const std::size_t self = nodes_.size();
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) {
    nodes_[self].first = std::int32_t(triangles_.size());
    nodes_[self].count = end - begin;
    for (std::int32_t n = begin; n < end; ++n)
      triangles_.push_back(corners[std::size_t(order[std::size_t(n)])]);
    return;
  }
  // Half of the triangles to either side of the longest extent of their middles.
  int axis = 0;
  for (int other = 1; other < 3; ++other)
    if (middle_most[other] - middle_least[other] > middle_most[axis] - middle_least[axis]) axis = other;
  const std::int32_t half = begin + (end - begin) / 2;
  std::nth_element(order.begin() + begin, order.begin() + half, order.begin() + end,
                   [&](std::int32_t a, std::int32_t b) {
                     const double ma = coordinate(middle[std::size_t(a)], axis);
                     const double mb = coordinate(middle[std::size_t(b)], axis);
                     return ma != mb ? ma < mb : a < b;
                   });
  build(order, middle, begin, half, corners);
  nodes_[self].first = std::int32_t(nodes_.size());
  build(order, middle, half, end, corners);
}

SurfaceIndex::Nearest SurfaceIndex::nearest(Vec3 point, std::int32_t guess) const {
  const auto box_distance = [&](const Node& n) {
    const double dx = std::max({n.least[0] - point.x, 0.0, point.x - n.most[0]});
    const double dy = std::max({n.least[1] - point.y, 0.0, point.y - n.most[1]});
    const double dz = std::max({n.least[2] - point.z, 0.0, point.z - n.most[2]});
    return dx * dx + dy * dy + dz * dz;
  };
  const Corners& first = triangles_[std::size_t(guess)];
  Nearest best{squared_distance(point, first.a, first.b, first.c), guess};
  struct Waiting {
    std::int32_t node;
    double distance;
  };
  std::array<Waiting, 128> stack;  // the tree is balanced: its depth is far below
  std::size_t height = 0;
  stack[height++] = {0, box_distance(nodes_[0])};
  while (height > 0) {
    const Waiting next = stack[--height];
    if (next.distance >= best.squared_distance) continue;
    const Node& node = nodes_[std::size_t(next.node)];
    for (std::int32_t t = node.first; node.count > 0 && t < node.first + node.count; ++t) {
      const Corners& corners = triangles_[std::size_t(t)];
      const double d = squared_distance(point, corners.a, corners.b, corners.c);
      if (d < best.squared_distance) best = {d, t};
    }
    if (node.count > 0) continue;
    const Waiting left{next.node + 1, box_distance(nodes_[std::size_t(next.node + 1)])};
    const Waiting right{node.first, box_distance(nodes_[std::size_t(node.first)])};
    // The nearer child comes off the stack first.
    stack[height++] = left.distance < right.distance ? right : left;
    stack[height++] = left.distance < right.distance ? left : right;
  }
  return best;
}

}  // namespace ctpm
