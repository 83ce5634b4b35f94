#include "core/surface/rigid_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace ctpm::surface {
namespace {

constexpr std::int32_t kTrianglesPerLeaf = 4;

double squared_distance(const Box& box, Vec3 p) {
  const auto beyond = [](double low, double high, double at) {
    return at < low ? low - at : at > high ? at - high : 0;
  };
  const Vec3 apart{beyond(box.low.x, box.high.x, p.x), beyond(box.low.y, box.high.y, p.y),
                   beyond(box.low.z, box.high.z, p.z)};
  return dot(apart, apart);
}

/// Angle with a cosine [rad], within 1e-4 (Abramowitz & Stegun 4.4.45): the same on every machine, unlike std::acos.
double angle_with(double cosine) {
  const double x = std::min(std::abs(cosine), 1.0);
  const double angle = std::sqrt(1 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - 0.0187293 * x)));
  return cosine < 0 ? 3.14159265358979323846 - angle : angle;
}

}  // namespace

RigidMesh::RigidMesh(std::vector<Vec3> vertex, const std::vector<Triangle>& triangle) : vertex_(std::move(vertex)) {
  for (const Triangle& t : triangle) {
    const Vec3 a = vertex_[std::size_t(t[0])], b = vertex_[std::size_t(t[1])], c = vertex_[std::size_t(t[2])];
    if (norm(cross(b - a, c - a)) > 0) triangle_.push_back(t);
  }
  if (triangle_.empty()) return;
  std::vector<std::int32_t> order(triangle_.size());
  std::iota(order.begin(), order.end(), 0);
  build(order, 0, std::int32_t(order.size()));
  std::vector<Triangle> sorted;
  for (const std::int32_t t : order) sorted.push_back(triangle_[std::size_t(t)]);
  triangle_ = std::move(sorted);
  find_normals();
}

/// Adds the node over `order[first, last)`, which it sorts, and all below it. Returns its index.
std::int32_t RigidMesh::build(std::vector<std::int32_t>& order, std::int32_t first, std::int32_t last) {
  Box box(corner(order[std::size_t(first)], 0)), middles(middle(order[std::size_t(first)]));
  for (std::int32_t i = first; i < last; ++i) {
    const std::int32_t t = order[std::size_t(i)];
    for (std::size_t c = 0; c < 3; ++c) box.add(corner(t, c));
    middles.add(middle(t));
  }
  const auto index = std::int32_t(nodes_.size());
  nodes_.push_back({box, first, last, -1});
  if (last - first <= kTrianglesPerLeaf) return index;
  const Vec3 size = middles.high - middles.low;
  const auto along = [&](std::int32_t t) {
    const Vec3 m = middle(t);
    return size.x >= size.y && size.x >= size.z ? m.x : size.y >= size.z ? m.y : m.z;
  };
  std::sort(order.begin() + first, order.begin() + last, [&](std::int32_t s, std::int32_t t) {
    const double a = along(s), b = along(t);
    return a != b ? a < b : s < t;
  });
  const std::int32_t half = first + (last - first) / 2;
  build(order, first, half);
  const std::int32_t second = build(order, half, last);
  nodes_[std::size_t(index)].second_child = second;
  return index;
}

void RigidMesh::find_normals() {
  std::map<std::pair<std::int32_t, std::int32_t>, Vec3> of_edge;
  std::vector<Vec3> of_vertex(vertex_.size());
  const auto edge = [](const Triangle& t, std::size_t c) { return std::minmax(t[c], t[(c + 1) % 3]); };
  normals_.resize(triangle_.size());
  for (std::size_t i = 0; i < triangle_.size(); ++i) {
    const Triangle& t = triangle_[i];
    const auto at = [&](std::size_t c) { return vertex_[std::size_t(t[c % 3])]; };
    const Vec3 across = cross(at(1) - at(0), at(2) - at(0)), normal = normals_[i][0] = across / norm(across);
    for (std::size_t c = 0; c < 3; ++c) {
      of_edge[edge(t, c)] += normal;
      const Vec3 next = at(c + 1) - at(c), last = at(c + 2) - at(c);
      of_vertex[std::size_t(t[c])] += angle_with(dot(next, last) / (norm(next) * norm(last))) * normal;
    }
  }
  for (std::size_t i = 0; i < triangle_.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      normals_[i][1 + c] = of_edge[edge(triangle_[i], c)];
      normals_[i][4 + c] = of_vertex[std::size_t(triangle_[i][c])];
    }
}

/// Ericson, "Real-time collision detection", 2005, section 5.1.5.
RigidMesh::Nearest RigidMesh::nearest_of(std::int32_t triangle, Vec3 point) const {
  const Vec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2), ab = b - a, ac = c - a;
  const double d1 = dot(ab, point - a), d2 = dot(ac, point - a);
  if (d1 <= 0 && d2 <= 0) return {a, 4};
  const double d3 = dot(ab, point - b), d4 = dot(ac, point - b);
  if (d3 >= 0 && d4 <= d3) return {b, 5};
  const double d5 = dot(ab, point - c), d6 = dot(ac, point - c);
  if (d6 >= 0 && d5 <= d6) return {c, 6};
  const double of_c = d1 * d4 - d3 * d2, of_b = d5 * d2 - d1 * d6, of_a = d3 * d6 - d5 * d4;
  if (of_c <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, 1};
  if (of_a <= 0 && d4 >= d3 && d5 >= d6) return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 2};
  if (of_b <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, 3};
  const double sum = of_a + of_b + of_c;
  return {a + of_b / sum * ab + of_c / sum * ac, 0};
}

Inside RigidMesh::inside(Vec3 point) const {
  double least = std::numeric_limits<double>::infinity();
  Nearest nearest{corner(0, 0), 4};
  std::int32_t nearest_triangle = 0;
  // A tree of 2^31 triangles is 31 deep; of both children of each node, one waits.
  std::array<std::int32_t, 64> waiting;
  std::size_t count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const std::int32_t index = waiting[--count];
    const Node& node = nodes_[std::size_t(index)];
    if (squared_distance(node.box, point) >= least) continue;
    if (node.second_child >= 0) {
      const std::int32_t first = index + 1, second = node.second_child;
      const bool is_first_nearer = squared_distance(nodes_[std::size_t(first)].box, point) <=
                                   squared_distance(nodes_[std::size_t(second)].box, point);
      waiting[count++] = is_first_nearer ? second : first;
      waiting[count++] = is_first_nearer ? first : second;
      continue;
    }
    for (std::int32_t t = node.first; t < node.last; ++t) {
      const Nearest found = nearest_of(t, point);
      const Vec3 apart = point - found.point;
      if (const double squared = dot(apart, apart); squared < least)
        least = squared, nearest = found, nearest_triangle = t;
    }
  }
  const Vec3 apart = point - nearest.point,
             normal = normals_[std::size_t(nearest_triangle)][std::size_t(nearest.feature)];
  if (nearest.feature == 0) return {-dot(point - corner(nearest_triangle, 0), normal), normal};
  const double distance = norm(apart), size = norm(normal);
  const bool is_inside = dot(apart, normal) < 0;
  if (!(distance > 0)) return {0, size > 0 ? normal / size : Vec3{0, 0, 1}};
  return {is_inside ? distance : -distance, (is_inside ? -1 : 1) * apart / distance};
}

}  // namespace ctpm::surface
