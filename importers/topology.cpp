#include "importers/topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

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

struct CellHash {
  std::size_t operator()(const std::array<std::int64_t, 3>& c) const {
    return mixed(std::uint64_t(c[0]), std::uint64_t(c[1]), std::uint64_t(c[2]));
  }
};

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

/// Maps vertices at equal positions to the first of them.
std::vector<std::int32_t> same_place(const Soup& soup) {
  std::unordered_map<std::array<std::int64_t, 3>, std::int32_t, CellHash> first_at;
  first_at.reserve(soup.vertex.size());
  std::vector<std::int32_t> representative(soup.vertex.size());
  for (std::size_t v = 0; v < soup.vertex.size(); ++v)
    representative[v] = first_at.emplace(bits_of(soup.vertex[v]), std::int32_t(v)).first->second;
  return representative;
}

/// Maps vertices within `distance` of an earlier kept vertex to the nearest such vertex.
void join_near(const Soup& soup, double distance, std::vector<std::int32_t>& representative) {
  const auto cell_of = [&](Vec3 p) {
    return std::array<std::int64_t, 3>{std::llround(std::floor(p.x / distance)),
                                       std::llround(std::floor(p.y / distance)),
                                       std::llround(std::floor(p.z / distance))};
  };
  std::unordered_map<std::array<std::int64_t, 3>, std::vector<std::int32_t>, CellHash> stays_in;
  for (std::size_t v = 0; v < soup.vertex.size(); ++v) {
    if (representative[v] != std::int32_t(v)) {
      representative[v] = representative[std::size_t(representative[v])];
      continue;
    }
    const auto cell = cell_of(soup.vertex[v]);
    std::int32_t nearest = -1;
    double nearest_distance = distance;
    for (int n = 0; n < 27; ++n) {
      const auto it = stays_in.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
      if (it == stays_in.end()) continue;
      for (const std::int32_t other : it->second) {
        const double d = norm(soup.vertex[std::size_t(other)] - soup.vertex[v]);
        if (d < nearest_distance || (d == nearest_distance && (nearest < 0 || other < nearest)))
          nearest = other, nearest_distance = d;
      }
    }
    if (nearest >= 0)
      representative[v] = nearest;
    else
      stays_in[cell].push_back(std::int32_t(v));
  }
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
  std::vector<std::pair<Edge, std::int32_t>> edges;
  edges.reserve(3 * triangle.size());
  for (std::size_t t = 0; t < triangle.size(); ++t)
    for (int c = 0; c < 3; ++c) edges.emplace_back(edge_of(triangle[t][c], triangle[t][(c + 1) % 3]), std::int32_t(t));
  std::sort(edges.begin(), edges.end());
  return edges;
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
  std::vector<std::int32_t> order(soup.triangle.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<Triangle> key;
  key.reserve(soup.triangle.size());
  for (const Triangle& t : soup.triangle) key.push_back(sorted(t));
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return key[std::size_t(a)] != key[std::size_t(b)] ? key[std::size_t(a)] < key[std::size_t(b)] : a < b;
  });
  std::vector<char> is_doubled(soup.triangle.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i)
    is_doubled[std::size_t(order[i])] = key[std::size_t(order[i])] == key[std::size_t(order[i - 1])];
  std::size_t next = 0;
  for (std::size_t t = 0; t < soup.triangle.size(); ++t)
    if (!is_doubled[t]) soup.triangle[next++] = soup.triangle[t];
  const std::int64_t dropped = std::int64_t(soup.triangle.size() - next);
  soup.triangle.resize(next);
  return dropped;
}

std::vector<std::int32_t> find_pinched(const Soup& soup) {
  // Store the triangles at each vertex contiguously.
  std::vector<std::int32_t> first(soup.vertex.size() + 1, 0);
  for (const Triangle& t : soup.triangle)
    for (const std::int32_t v : t) ++first[std::size_t(v) + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::int32_t> next(first.begin(), first.end() - 1), around(3 * soup.triangle.size());
  for (std::size_t t = 0; t < soup.triangle.size(); ++t)
    for (const std::int32_t v : soup.triangle[t]) around[std::size_t(next[std::size_t(v)]++)] = std::int32_t(t);

  std::vector<std::int32_t> pinched;
  std::vector<std::pair<std::int32_t, std::int32_t>> spokes;  // other end of an edge, and local index of its triangle
  for (std::size_t v = 0; v < soup.vertex.size(); ++v) {
    const std::int32_t count = first[v + 1] - first[v];
    spokes.clear();
    for (std::int32_t n = 0; n < count; ++n)
      for (const std::int32_t other : soup.triangle[std::size_t(around[std::size_t(first[v] + n)])])
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

Parts find_parts(const std::vector<Triangle>& triangle) {
  Sets sets(triangle.size());
  const auto edges = sorted_edges(triangle);
  for (std::size_t e = 1; e < edges.size(); ++e)
    if (edges[e].first == edges[e - 1].first) sets.join(edges[e].second, edges[e - 1].second);
  Parts parts;
  parts.of_triangle.resize(triangle.size());
  // The root of a set is its first triangle, so roots precede their members.
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    const std::int32_t root = sets.root(std::int32_t(t));
    parts.of_triangle[t] = std::size_t(root) == t ? parts.count++ : parts.of_triangle[std::size_t(root)];
  }
  return parts;
}

std::int64_t count_joined(const std::vector<Triangle>& triangle) {
  std::int32_t vertex_count = 0;
  for (const Triangle& t : triangle) vertex_count = std::max({vertex_count, t[0] + 1, t[1] + 1, t[2] + 1});
  Sets sets(static_cast<std::size_t>(vertex_count));
  std::vector<char> is_used(static_cast<std::size_t>(vertex_count), 0);
  for (const Triangle& t : triangle) {
    sets.join(t[0], t[1]), sets.join(t[0], t[2]);
    for (const std::int32_t v : t) is_used[std::size_t(v)] = 1;
  }
  std::int64_t groups = 0;
  for (std::int32_t v = 0; v < vertex_count; ++v) groups += is_used[std::size_t(v)] && sets.root(v) == v;
  return groups;
}

MeshCounts count_mesh(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle) {
  MeshCounts counts;
  counts.vertices = std::int64_t(vertex.size());
  counts.triangles = std::int64_t(triangle.size());
  counts.parts = find_parts(triangle).count;
  const auto edges = sorted_edges(triangle);
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
  std::unordered_map<std::array<std::int64_t, 3>, std::int32_t, CellHash> vertex_at;
  vertex_at.reserve(before.vertex.size());
  for (std::size_t v = 0; v < before.vertex.size(); ++v) vertex_at.emplace(bits_of(before.vertex[v]), std::int32_t(v));
  std::vector<Triangle> old_triangles;
  old_triangles.reserve(before.triangle.size());
  for (const Triangle& t : before.triangle) old_triangles.push_back(rotated(t));
  std::sort(old_triangles.begin(), old_triangles.end());

  Turned count;
  for (const Triangle& t : after.triangle) {
    Triangle old{};
    bool is_old = true;
    for (int c = 0; c < 3 && is_old; ++c) {
      const auto it = vertex_at.find(bits_of(after.vertex[std::size_t(t[c])]));
      is_old = it != vertex_at.end();
      if (is_old) old[c] = it->second;
    }
    if (!is_old) continue;
    const auto has = [&](Triangle wanted) {
      return std::binary_search(old_triangles.begin(), old_triangles.end(), rotated(wanted));
    };
    if (has(old))
      ++count.kept;
    else if (has({old[0], old[2], old[1]}))
      ++count.turned;
  }
  return count;
}

}  // namespace ctpm::importers
