#include "importers/topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

namespace ctpm::importers {
namespace {

using Edge = std::uint64_t;

Edge edge_of(std::int32_t a, std::int32_t b) {
  return (std::uint64_t(std::uint32_t(std::min(a, b))) << 32) | std::uint32_t(std::max(a, b));
}

std::uint64_t mixed(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  std::uint64_t h = a * 0x9E3779B97F4A7C15u;
  h = (h ^ (h >> 29) ^ b) * 0xBF58476D1CE4E5B9u;
  h = (h ^ (h >> 32) ^ c) * 0x94D049BB133111EBu;
  return h ^ (h >> 31);
}

/// The bits of a position, with -0 mapped to 0.
std::array<std::int64_t, 3> bits_of(Vec3 p) {
  std::array<std::int64_t, 3> bits{};
  const std::array<double, 3> clean{p.x + 0.0, p.y + 0.0, p.z + 0.0};
  std::memcpy(bits.data(), clean.data(), sizeof bits);
  return bits;
}

/// Disjoint sets (union-find).
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::int32_t root(std::int32_t i) {
    while (parent_[std::size_t(i)] != i) i = parent_[std::size_t(i)] = parent_[std::size_t(parent_[std::size_t(i)])];
    return i;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = root(a), b = root(b);
    parent_[std::size_t(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<std::int32_t> parent_;
};

/// Renumbers the soup with `new_of_old` (an index of `kept`) and drops unused vertices.
void renumber(Soup& soup, const std::vector<std::int32_t>& representative) {
  std::vector<std::int32_t> new_index(soup.vertex.size(), -1);
  std::vector<Vec3> kept;
  for (Triangle& triangle : soup.triangle)
    for (std::int32_t& v : triangle) {
      const std::size_t r = std::size_t(representative[std::size_t(v)]);
      if (new_index[r] < 0) {
        new_index[r] = std::int32_t(kept.size());
        kept.push_back(soup.vertex[r]);
      }
      v = new_index[r];
    }
  soup.vertex = std::move(kept);
}

/// Vertices by what they are found by, in a table of open addressing; at most `count` of them.
class VertexTable {
 public:
  explicit VertexTable(std::size_t count) : slot_(std::bit_ceil(2 * count + 1), -1) {}

  /// The slot of the vertex for which `is_it(vertex)` is true, or the free one where it belongs.
  template <class IsIt>
  std::int32_t& find(std::uint64_t hash, const IsIt& is_it) {
    std::size_t at = hash & (slot_.size() - 1);
    while (slot_[at] >= 0 && !is_it(slot_[at])) at = (at + 1) & (slot_.size() - 1);
    return slot_[at];
  }

 private:
  std::vector<std::int32_t> slot_;
};

/// The first vertex at each place.
class Places {
 public:
  explicit Places(const std::vector<Vec3>& vertex) : vertex_(vertex), table_(vertex.size()) {
    for (std::size_t v = 0; v < vertex.size(); ++v)
      if (std::int32_t& slot = slot_of(vertex[v]); slot < 0) slot = std::int32_t(v);
  }
  std::int32_t find(Vec3 place) { return slot_of(place); }  ///< -1: none

 private:
  std::int32_t& slot_of(Vec3 place) {
    const auto bits = bits_of(place);
    return table_.find(mixed(std::uint64_t(bits[0]), std::uint64_t(bits[1]), std::uint64_t(bits[2])),
                       [&](std::int32_t v) { return bits_of(vertex_[std::size_t(v)]) == bits; });
  }

  const std::vector<Vec3>& vertex_;
  VertexTable table_;
};

/// Maps vertices at equal positions to the first of them.
std::vector<std::int32_t> same_place(const Soup& soup) {
  Places places(soup.vertex);
  std::vector<std::int32_t> representative(soup.vertex.size());
  for (std::size_t v = 0; v < soup.vertex.size(); ++v) representative[v] = places.find(soup.vertex[v]);
  return representative;
}

/// Vertices that stay, in cells so much larger than the distance that few balls reach beyond one.
class StayGrid {
 public:
  StayGrid(const std::vector<Vec3>& vertex, double distance)
      : vertex_(vertex), distance_(distance), table_(vertex.size()), next_(vertex.size(), -1) {}

  void add(std::int32_t v) {
    std::int32_t& head = head_of(cell_of(vertex_[std::size_t(v)]));
    next_[std::size_t(v)] = head, head = v;
  }

  /// The nearest within the distance, the first of equally near ones; -1: none.
  std::int32_t nearest_to(std::int32_t v) {
    constexpr double kRounding = 1 + 1e-6;
    const Vec3 place = vertex_[std::size_t(v)], reach = kRounding * distance_ * Vec3{1, 1, 1};
    const Cell least = cell_of(place - reach), most = cell_of(place + reach);
    std::int32_t nearest = -1;
    double nearest_distance = distance_;
    for (std::int64_t i = least[0]; i <= most[0]; ++i)
      for (std::int64_t j = least[1]; j <= most[1]; ++j)
        for (std::int64_t k = least[2]; k <= most[2]; ++k)
          for (std::int32_t other = head_of({i, j, k}); other >= 0; other = next_[std::size_t(other)]) {
            const double d = norm(vertex_[std::size_t(other)] - place);
            if (d < nearest_distance || (d == nearest_distance && (nearest < 0 || other < nearest)))
              nearest = other, nearest_distance = d;
          }
    return nearest;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(Vec3 p) const {
    constexpr double kCell = 16;  // distances
    const auto index = [&](double x) { return std::llround(std::floor(x / (kCell * distance_))); };
    return {index(p.x), index(p.y), index(p.z)};
  }
  std::int32_t& head_of(const Cell& cell) {
    return table_.find(mixed(std::uint64_t(cell[0]), std::uint64_t(cell[1]), std::uint64_t(cell[2])),
                       [&](std::int32_t v) { return cell_of(vertex_[std::size_t(v)]) == cell; });
  }

  const std::vector<Vec3>& vertex_;
  double distance_;
  VertexTable table_;
  std::vector<std::int32_t> next_;
};

/// Maps vertices within `distance` of an earlier kept vertex to the nearest such vertex.
void join_near(const Soup& soup, double distance, std::vector<std::int32_t>& representative) {
  StayGrid stays(soup.vertex, distance);
  for (std::size_t v = 0; v < soup.vertex.size(); ++v) {
    if (representative[v] != std::int32_t(v)) {
      representative[v] = representative[std::size_t(representative[v])];
      continue;
    }
    const std::int32_t nearest = stays.nearest_to(std::int32_t(v));
    if (nearest >= 0)
      representative[v] = nearest;
    else
      stays.add(std::int32_t(v));
  }
}

/// Numbers in groups, each in ascending order.
struct Groups {
  std::vector<std::int32_t> first;  ///< of each group in `number`, and their end (group_count + 1)
  std::vector<std::int32_t> number;
};

/// The numbers from 0 to `count` by `group_of(number)`, in time that is linear in them.
template <class GroupOf>
Groups group_by(std::size_t count, std::size_t groups, const GroupOf& group_of) {
  Groups by{std::vector<std::int32_t>(groups + 1, 0), std::vector<std::int32_t>(count)};
  for (std::size_t n = 0; n < count; ++n) ++by.first[std::size_t(group_of(n)) + 1];
  for (std::size_t g = 1; g < by.first.size(); ++g) by.first[g] += by.first[g - 1];
  std::vector<std::int32_t> next(by.first.begin(), by.first.end() - 1);
  for (std::size_t n = 0; n < count; ++n) by.number[std::size_t(next[std::size_t(group_of(n))]++)] = std::int32_t(n);
  return by;
}

/// One more than the largest index of a vertex.
std::size_t vertices_of(const std::vector<Triangle>& triangle) {
  std::int32_t count = 0;
  for (const Triangle& t : triangle) count = std::max({count, t[0] + 1, t[1] + 1, t[2] + 1});
  return std::size_t(count);
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// The same cyclic order, with the smallest index first.
Triangle rotated(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

}  // namespace

std::vector<std::pair<Edge, std::int32_t>> sorted_edges(const std::vector<Triangle>& triangle) {
  const auto edge = [&](std::size_t n) { return edge_of(triangle[n / 3][n % 3], triangle[n / 3][(n + 1) % 3]); };
  const Groups by = group_by(3 * triangle.size(), vertices_of(triangle), [&](std::size_t n) { return edge(n) >> 32; });
  std::vector<std::pair<Edge, std::int32_t>> edges;
  edges.reserve(by.number.size());
  for (const std::int32_t n : by.number) edges.emplace_back(edge(std::size_t(n)), n / 3);
  for (std::size_t v = 0; v + 1 < by.first.size(); ++v)
    std::sort(edges.begin() + by.first[v], edges.begin() + by.first[v + 1]);
  return edges;
}

bool is_closed_and_oriented(const std::vector<Triangle>& triangle) {
  const auto edges = sorted_edges(triangle);
  // Whether triangle `t` runs along the edge from its smaller vertex.
  const auto runs_up = [&](std::size_t e) {
    const Triangle& t = triangle[std::size_t(edges[e].second)];
    const auto low = std::int32_t(edges[e].first >> 32), high = std::int32_t(edges[e].first & 0xFFFFFFFFu);
    return (t[0] == low && t[1] == high) || (t[1] == low && t[2] == high) || (t[2] == low && t[0] == high);
  };
  for (std::size_t e = 0; e < edges.size(); e += 2) {
    const bool is_pair = e + 1 < edges.size() && edges[e].first == edges[e + 1].first &&
                         (e + 2 == edges.size() || edges[e + 2].first != edges[e].first);
    if (!is_pair || runs_up(e) == runs_up(e + 1)) return false;
  }
  return true;
}

BoundingBox bounding_box(const Soup& soup) {
  BoundingBox box;
  bool is_first = true;
  for (const Triangle& triangle : soup.triangle)
    for (const std::int32_t v : triangle) {
      const Vec3 p = soup.vertex[std::size_t(v)];
      if (is_first) box = {p, p};
      is_first = false;
      box.least = {std::min(box.least.x, p.x), std::min(box.least.y, p.y), std::min(box.least.z, p.z)};
      box.most = {std::max(box.most.x, p.x), std::max(box.most.y, p.y), std::max(box.most.z, p.z)};
    }
  return box;
}

void drop_unused(Soup& soup) {
  std::vector<std::int32_t> itself(soup.vertex.size());
  std::iota(itself.begin(), itself.end(), 0);
  renumber(soup, itself);
}

std::int64_t weld(Soup& soup, double distance) {
  drop_unused(soup);
  const std::size_t count_before = soup.vertex.size();
  std::vector<std::int32_t> representative = same_place(soup);
  if (distance > 0) join_near(soup, distance, representative);
  renumber(soup, representative);
  return std::int64_t(count_before - soup.vertex.size());
}

std::int64_t drop_collapsed(Soup& soup) {
  return std::int64_t(
      std::erase_if(soup.triangle, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }));
}

std::int64_t drop_duplicates(Soup& soup) {
  const auto key = [&](std::int32_t t) { return sorted(soup.triangle[std::size_t(t)]); };
  Groups by = group_by(soup.triangle.size(), vertices_of(soup.triangle),
                       [&](std::size_t t) { return key(std::int32_t(t))[0]; });
  std::vector<char> is_doubled(soup.triangle.size(), 0);
  for (std::size_t v = 0; v + 1 < by.first.size(); ++v) {
    const auto begin = by.number.begin() + by.first[v], end = by.number.begin() + by.first[v + 1];
    std::sort(begin, end, [&](std::int32_t a, std::int32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    for (auto t = begin; t != end; ++t) is_doubled[std::size_t(*t)] = t != begin && key(*t) == key(*(t - 1));
  }
  std::size_t next = 0;
  for (std::size_t t = 0; t < soup.triangle.size(); ++t)
    if (!is_doubled[t]) soup.triangle[next++] = soup.triangle[t];
  const std::int64_t dropped = std::int64_t(soup.triangle.size() - next);
  soup.triangle.resize(next);
  return dropped;
}

std::vector<std::int32_t> find_pinched(const Soup& soup) {
  const Groups around = group_by(3 * soup.triangle.size(), soup.vertex.size(),
                                 [&](std::size_t n) { return soup.triangle[n / 3][n % 3]; });
  std::vector<std::int32_t> pinched;
  std::vector<std::pair<std::int32_t, std::int32_t>> spokes;  // other end of an edge, and local index of its triangle
  for (std::size_t v = 0; v < soup.vertex.size(); ++v) {
    const std::int32_t count = around.first[v + 1] - around.first[v];
    spokes.clear();
    for (std::int32_t n = 0; n < count; ++n)
      for (const std::int32_t other : soup.triangle[std::size_t(around.number[std::size_t(around.first[v] + n)] / 3)])
        if (other != std::int32_t(v)) spokes.emplace_back(other, n);
    std::sort(spokes.begin(), spokes.end());
    Sets fans(static_cast<std::size_t>(count));
    std::int32_t fan_count = count;
    for (std::size_t s = 1; s < spokes.size(); ++s) {
      if (spokes[s].first != spokes[s - 1].first || fans.root(spokes[s].second) == fans.root(spokes[s - 1].second))
        continue;
      fans.join(spokes[s].second, spokes[s - 1].second);
      --fan_count;
    }
    if (fan_count > 1) pinched.push_back(std::int32_t(v));
  }
  return pinched;
}

std::vector<Vec3> find_non_manifold_edges(const Soup& soup) {
  std::vector<Vec3> middles;
  const auto edges = sorted_edges(soup.triangle);
  for (std::size_t e = 2; e < edges.size(); ++e) {
    const bool is_third = edges[e].first == edges[e - 2].first && (e < 3 || edges[e].first != edges[e - 3].first);
    if (!is_third) continue;
    const auto end = [&](std::uint64_t v) { return soup.vertex[std::size_t(v & 0xFFFFFFFFu)]; };
    middles.push_back(0.5 * (end(edges[e].first >> 32) + end(edges[e].first)));
  }
  return middles;
}

namespace {

Parts parts_by(const std::vector<std::pair<Edge, std::int32_t>>& edges, std::size_t triangles) {
  Sets sets(triangles);
  for (std::size_t e = 1; e < edges.size(); ++e)
    if (edges[e].first == edges[e - 1].first) sets.join(edges[e].second, edges[e - 1].second);
  Parts parts;
  parts.of_triangle.resize(triangles);
  // The root of a set is its first triangle, so roots precede their members.
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::int32_t root = sets.root(std::int32_t(t));
    parts.of_triangle[t] = std::size_t(root) == t ? parts.count++ : parts.of_triangle[std::size_t(root)];
  }
  return parts;
}

}  // namespace

Parts find_parts(const std::vector<Triangle>& triangle) { return parts_by(sorted_edges(triangle), triangle.size()); }

std::int64_t count_joined(const std::vector<Triangle>& triangle) {
  const std::size_t vertex_count = vertices_of(triangle);
  Sets sets(vertex_count);
  std::vector<char> is_used(vertex_count, 0);
  for (const Triangle& t : triangle) {
    sets.join(t[0], t[1]), sets.join(t[0], t[2]);
    for (const std::int32_t v : t) is_used[std::size_t(v)] = 1;
  }
  std::int64_t groups = 0;
  for (std::int32_t v = 0; v < std::int32_t(vertex_count); ++v) groups += is_used[std::size_t(v)] && sets.root(v) == v;
  return groups;
}

MeshCounts count_mesh(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle) {
  MeshCounts counts;
  counts.vertices = std::int64_t(vertex.size());
  counts.triangles = std::int64_t(triangle.size());
  const auto edges = sorted_edges(triangle);
  counts.parts = parts_by(edges, triangle.size()).count;
  for (std::size_t e = 0; e < edges.size();) {
    std::size_t end = e;
    while (end < edges.size() && edges[end].first == edges[e].first) ++end;
    counts.open_edges += end - e == 1;
    counts.non_manifold_edges += end - e > 2;
    e = end;
  }
  return counts;
}

double signed_volume(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle, Vec3 from) {
  double sum = 0;
  for (const Triangle& t : triangle)
    sum += dot(vertex[std::size_t(t[0])] - from,
               cross(vertex[std::size_t(t[1])] - from, vertex[std::size_t(t[2])] - from));
  return sum / 6;
}

double surface_area(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle) {
  double sum = 0;
  for (const Triangle& t : triangle) {
    const Vec3 a = vertex[std::size_t(t[0])];
    sum += norm(cross(vertex[std::size_t(t[1])] - a, vertex[std::size_t(t[2])] - a));
  }
  return sum / 2;
}

Turned count_turned(const Soup& before, const Soup& after) {
  Places places(before.vertex);
  std::vector<std::int32_t> place_of(after.vertex.size());
  for (std::size_t v = 0; v < after.vertex.size(); ++v) place_of[v] = places.find(after.vertex[v]);
  const auto old_at = [&](std::int32_t n) { return rotated(before.triangle[std::size_t(n)]); };
  const Groups by =
      group_by(before.triangle.size(), before.vertex.size(), [&](std::size_t t) { return old_at(std::int32_t(t))[0]; });

  Turned count;
  for (const Triangle& t : after.triangle) {
    Triangle old{};
    bool is_old = true;
    for (int c = 0; c < 3 && is_old; ++c) {
      old[c] = place_of[std::size_t(t[c])];
      is_old = old[c] >= 0;
    }
    if (!is_old) continue;
    const auto has = [&](Triangle wanted) {
      wanted = rotated(wanted);
      const auto v = std::size_t(wanted[0]);
      return std::any_of(by.number.begin() + by.first[v], by.number.begin() + by.first[v + 1],
                         [&](std::int32_t n) { return old_at(n) == wanted; });
    };
    if (has(old))
      ++count.kept;
    else if (has({old[0], old[2], old[1]}))
      ++count.turned;
  }
  return count;
}

}  // namespace ctpm::importers
