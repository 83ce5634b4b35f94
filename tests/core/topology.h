#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace ctpm::testing {

using Triangles = std::vector<std::array<std::int32_t, 3>>;

/// Edges that do not belong to as many triangles in one direction as in the other.
inline int open_edges(const Triangles& triangles) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      if (a != b) edges[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  return int(std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second != 0; }));
}

/// Parts that share no vertex.
inline int components(const Triangles& triangles) {
  std::map<int, int> parent;
  const std::function<int(int)> root = [&](int v) {
    const auto it = parent.try_emplace(v, v).first;
    return it->second == v ? v : it->second = root(it->second);
  };
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) parent[root(t[i])] = root(t[(i + 1) % 3]);
  std::set<int> roots;
  for (const auto& [v, p] : parent) roots.insert(root(v));
  return int(roots.size());
}

}  // namespace ctpm::testing
