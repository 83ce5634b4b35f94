#include "importers/seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace ctpm::importers {
namespace {

constexpr std::int64_t kMostLooks = 50'000'000;  // limit on grid lookups; only a hostile mesh needs more
constexpr std::size_t kMostAtEdge = 64;          // limit on triangles at one edge; only a hostile mesh has more

using Cell = std::array<std::int64_t, 3>;
using Edges = std::vector<std::pair<std::uint64_t, std::int32_t>>;

std::int32_t first_end(std::uint64_t edge) { return std::int32_t(edge >> 32); }
std::int32_t second_end(std::uint64_t edge) { return std::int32_t(edge & 0xFFFFFFFFu); }

/// All entries [first, last) of the sorted edges that are the same edge as entry `e`.
struct Around {
  std::size_t first, last;
};
Around around(const Edges& edges, std::size_t e) {
  Around a{e, e + 1};
  while (a.first > 0 && edges[a.first - 1].first == edges[e].first) --a.first;
  while (a.last < edges.size() && edges[a.last].first == edges[e].first) ++a.last;
  return a;
}

/// Edges with only one triangle.
Edges rim_of(const Soup& soup) {
  const Edges edges = sorted_edges(soup.triangle);
  Edges rim;
  for (std::size_t e = 0; e < edges.size();) {
    const Around all = around(edges, e);
    if (all.last - all.first == 1) rim.push_back(edges[e]);
    e = all.last;
  }
  return rim;
}

/// Grid of boundary vertices, to find those near an edge.
class RimGrid {
 public:
  RimGrid(const Soup& soup, const Edges& rim, double distance) : soup_(soup) {
    std::vector<double> lengths;
    for (const auto& [edge, triangle] : rim) lengths.push_back(norm(at(second_end(edge)) - at(first_end(edge))));
    std::nth_element(lengths.begin(), lengths.begin() + std::ptrdiff_t(lengths.size() / 2), lengths.end());
    size_ = std::max(lengths[lengths.size() / 2], distance);
    std::vector<std::int32_t> vertices;
    for (const auto& [edge, triangle] : rim) vertices.push_back(first_end(edge)), vertices.push_back(second_end(edge));
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const std::int32_t v : vertices) cells_[cell_of(at(v))].push_back(v);
  }

  /// Vertices within `distance` of the edge a-b but not of its ends, in order from a to b.
  std::vector<std::int32_t> on(std::int32_t a, std::int32_t b, double distance) {
    const Vec3 from = at(a), along = at(b) - at(a);
    const double length = norm(along);
    std::map<double, std::int32_t> found;
    if (!(length > 2 * distance)) return {};
    const auto steps = std::int64_t(std::ceil(length / size_));
    for (std::int64_t step = 0; step <= steps && looks_ < kMostLooks; ++step)
      look_around(cell_of(from + (double(step) / double(steps)) * along), [&](std::int32_t v) {
        if (v == a || v == b) return;
        const double t = dot(at(v) - from, along) / (length * length);
        const bool is_between = t * length > distance && (1 - t) * length > distance;
        if (is_between && norm(at(v) - from - t * along) <= distance) found.emplace(t, v);
      });
    std::vector<std::int32_t> vertices;
    for (const auto& [t, v] : found) vertices.push_back(v);
    return vertices;
  }

 private:
  Vec3 at(std::int32_t v) const { return soup_.vertex[std::size_t(v)]; }
  Cell cell_of(Vec3 p) const {
    const auto index = [&](double x) { return std::int64_t(std::floor(x / size_)); };
    return {index(p.x), index(p.y), index(p.z)};
  }
  template <class Visit>
  void look_around(const Cell& cell, Visit&& visit) {
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) {
          const auto it = cells_.find({cell[0] + i, cell[1] + j, cell[2] + k});
          ++looks_;
          if (it == cells_.end()) continue;
          looks_ += std::int64_t(it->second.size());
          for (const std::int32_t v : it->second) visit(v);
        }
  }

  const Soup& soup_;
  double size_ = 0;  ///< edge length of a grid cell
  std::int64_t looks_ = 0;
  std::map<Cell, std::vector<std::int32_t>> cells_;
};

/// Splits the triangle's edge that starts at corner `c` at `vertices`, into a fan from the opposite corner.
void split_edge(Soup& soup, std::size_t t, int c, const std::vector<std::int32_t>& vertices) {
  const Triangle old = soup.triangle[t];
  const std::int32_t b = old[(c + 1) % 3], across = old[(c + 2) % 3];
  std::int32_t from = old[c];
  soup.triangle[t] = {from, vertices.front(), across};
  for (std::size_t i = 0; i < vertices.size(); ++i)
    soup.triangle.push_back({vertices[i], i + 1 < vertices.size() ? vertices[i + 1] : b, across});
}

/// Splits at most one edge of each triangle. Returns the positions.
std::vector<Vec3> split_once(Soup& soup, double distance) {
  std::vector<Vec3> places;
  const Edges rim = rim_of(soup);
  if (rim.empty()) return places;
  RimGrid grid(soup, rim, distance);
  std::vector<char> is_split(soup.triangle.size(), 0);
  for (const auto& [edge, t] : rim) {
    if (is_split[std::size_t(t)]) continue;
    const Triangle triangle = soup.triangle[std::size_t(t)];
    for (int c = 0; c < 3; ++c) {
      const std::int32_t a = triangle[c], b = triangle[(c + 1) % 3], across = triangle[(c + 2) % 3];
      if (std::min(a, b) != first_end(edge) || std::max(a, b) != second_end(edge)) continue;
      std::vector<std::int32_t> vertices = grid.on(a, b, distance);
      std::erase(vertices, across);
      if (vertices.empty()) continue;
      for (const std::int32_t v : vertices) places.push_back(soup.vertex[std::size_t(v)]);
      split_edge(soup, std::size_t(t), c, vertices);
      is_split[std::size_t(t)] = 1;
    }
  }
  return places;
}

}  // namespace

std::vector<Vec3> split_t_junctions(Soup& soup, double distance) {
  std::vector<Vec3> places;
  // A triangle has three edges, and a split makes no longer edges, so three passes suffice.
  for (int pass = 0; pass < 3; ++pass) {
    const std::vector<Vec3> more = split_once(soup, distance);
    if (more.empty()) break;
    places.insert(places.end(), more.begin(), more.end());
  }
  return places;
}

namespace {

/// A walk over the outside of one part from edge to edge. A facet is one side of triangle t: 2 t for the side from
/// which its corners run counter-clockwise, 2 t + 1 for the other.
class Outside {
 public:
  explicit Outside(const Soup& soup)
      : soup_(soup), edges_(sorted_edges(soup.triangle)), is_seen_(2 * soup.triangle.size(), 0) {}

  /// Marks every facet reachable from the outermost facet of a part.
  void walk(const std::vector<std::int32_t>& part) {
    std::vector<std::int32_t> open;
    const auto see = [&](std::int32_t facet) {
      if (facet < 0 || is_seen_[std::size_t(facet)]) return;
      is_seen_[std::size_t(facet)] = 1, open.push_back(facet);
    };
    see(outermost(part));
    while (!open.empty()) {
      const std::int32_t facet = open.back();
      open.pop_back();
      for (int c = 0; c < 3; ++c) see(next(facet, c));
    }
  }
  bool is_seen(std::int32_t t) const { return is_seen_[2 * std::size_t(t)] || is_seen_[2 * std::size_t(t) + 1]; }

 private:
  Vec3 at(std::int32_t v) const { return soup_.vertex[std::size_t(v)]; }

  /// The last facet hit by the line along x through the centroid of the widest triangle; -1: none.
  std::int32_t outermost(const std::vector<std::int32_t>& part) const {
    double widest = 0;
    Vec3 middle;
    for (const std::int32_t t : part) {
      const Triangle& v = soup_.triangle[std::size_t(t)];
      const double width = std::abs(cross(at(v[1]) - at(v[0]), at(v[2]) - at(v[0])).x);
      if (width > widest) widest = width, middle = (at(v[0]) + at(v[1]) + at(v[2])) / 3;
    }
    std::int32_t last = -1;
    double farthest = -INFINITY;
    for (const std::int32_t t : part) {
      const Triangle& v = soup_.triangle[std::size_t(t)];
      const Vec3 normal = cross(at(v[1]) - at(v[0]), at(v[2]) - at(v[0]));
      const double sign = normal.x > 0 ? 1 : -1;
      bool is_hit = normal.x != 0;
      for (int c = 0; c < 3; ++c) {
        const Vec3 p = at(v[c]) - middle, q = at(v[(c + 1) % 3]) - middle;
        is_hit = is_hit && sign * (p.y * q.z - p.z * q.y) > 0;
      }
      if (!is_hit) continue;
      const double x = dot(normal, at(v[0]) - middle) / normal.x;
      if (x > farthest) farthest = x, last = 2 * t + (normal.x > 0 ? 0 : 1);
    }
    return last;
  }

  /// The next facet when rotating outwards about the edge that starts at corner `c` of a facet; -1 at a boundary.
  std::int32_t next(std::int32_t facet, int c) const {
    const Triangle& own = soup_.triangle[std::size_t(facet / 2)];
    std::int32_t a = own[c], b = own[(c + 1) % 3];
    if (facet % 2 == 1) std::swap(a, b);
    const Vec3 axis = at(b) - at(a), out = at(own[(c + 2) % 3]) - at(a);
    const std::uint64_t key = (std::uint64_t(std::min(a, b)) << 32) | std::uint32_t(std::max(a, b));
    const auto entry = std::lower_bound(edges_.begin(), edges_.end(), std::pair{key, std::int32_t(0)});
    const Around all = around(edges_, std::size_t(entry - edges_.begin()));
    const double length = norm(axis);
    const Vec3 up = cross(axis, out);  // points to the side of the facet
    std::int32_t nearest = -1;
    double least = INFINITY;
    for (std::size_t e = all.first; e < all.last; ++e) {
      const std::int32_t t = edges_[e].second;
      if (t == facet / 2) continue;
      const Triangle& v = soup_.triangle[std::size_t(t)];
      int d = 0;
      while (v[d] == a || v[d] == b) ++d;
      const Vec3 other = at(v[d]) - at(a);
      // The component of `other` perpendicular to the axis, in the frame of `out` and `up`.
      const double along_up = dot(other, up) / length;
      const double along_out = dot(other - (dot(other, axis) / (length * length)) * axis, out);
      double turn = std::atan2(along_up, along_out);
      if (turn <= 0) turn += 2 * std::numbers::pi;
      if (turn >= least) continue;
      // Seen from outside, a neighbour traverses the common edge from b to a.
      const bool runs_back = v[(d + 1) % 3] == b;
      least = turn, nearest = 2 * t + (runs_back ? 0 : 1);
    }
    return nearest;
  }

  const Soup& soup_;
  Edges edges_;
  std::vector<char> is_seen_;
};

/// Whether removing the walls would leave an edge with one triangle.
bool opens_an_edge(const Edges& edges, const std::vector<char>& is_wall) {
  for (std::size_t e = 0; e < edges.size();) {
    const Around all = around(edges, e);
    std::size_t walls = 0;
    for (std::size_t i = all.first; i < all.last; ++i) walls += is_wall[std::size_t(edges[i].second)];
    const std::size_t stay = all.last - all.first - walls;
    if (walls > 0 && stay == 1) return true;
    e = all.last;
  }
  return false;
}

}  // namespace

std::vector<std::int32_t> find_inner_walls(const Soup& soup) {
  if (find_non_manifold_edges(soup).empty()) return {};
  const Edges edges = sorted_edges(soup.triangle);
  for (std::size_t e = kMostAtEdge; e < edges.size(); ++e)
    if (edges[e].first == edges[e - kMostAtEdge].first) return {};
  const Parts parts = find_parts(soup.triangle);
  std::vector<std::vector<std::int32_t>> members(std::size_t(parts.count));
  for (std::size_t t = 0; t < soup.triangle.size(); ++t)
    members[std::size_t(parts.of_triangle[t])].push_back(std::int32_t(t));
  Outside outside(soup);
  std::vector<char> is_wall(soup.triangle.size(), 0);
  for (const std::vector<std::int32_t>& part : members) {
    outside.walk(part);
    for (const std::int32_t t : part) is_wall[std::size_t(t)] = outside.is_seen(t) ? 0 : 1;
  }
  if (opens_an_edge(edges, is_wall)) return {};
  std::vector<std::int32_t> walls;
  for (std::size_t t = 0; t < is_wall.size(); ++t)
    if (is_wall[t]) walls.push_back(std::int32_t(t));
  return walls;
}

}  // namespace ctpm::importers
