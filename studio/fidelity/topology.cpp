#include "studio/fidelity/topology.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace ctpm::fidelity {
namespace {

/// Numbers of the vertices; those that always move together have the same one.
std::vector<std::int32_t> weld(const Surface& surface) {
  std::map<std::pair<std::array<double, 3>, std::vector<double>>, std::int32_t> known;
  std::vector<std::int32_t> number;
  const SurfaceBinding& b = surface.binding;
  for (std::size_t v = 0; v < surface.vertex.size(); ++v) {
    const Vec3 p = surface.vertex[v];
    std::vector<double> followed;
    for (auto e = std::size_t(b.first[v]); e < std::size_t(b.first[v + 1]); ++e)
      followed.push_back(b.sphere[e]), followed.push_back(b.weight[e]);
    number.push_back(
        known.try_emplace({{p.x, p.y, p.z}, std::move(followed)}, std::int32_t(known.size())).first->second);
  }
  return number;
}

}  // namespace

Topology topology_of(const Surface& surface) {
  Topology row;
  const std::vector<std::int32_t> number = weld(surface);
  std::vector<std::int32_t> root(number.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::int32_t v) {
    while (root[std::size_t(v)] != v) v = root[std::size_t(v)] = root[std::size_t(root[std::size_t(v)])];
    return v;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
  for (const auto& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = number[std::size_t(t[i])], b = number[std::size_t(t[(i + 1) % 3])];
      root[std::size_t(find(a))] = find(b);
      if (a != b) edges[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  row.open_edges = int(std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; }));
  std::vector<std::uint8_t> is_used(number.size(), 0);
  for (const auto& t : surface.triangle) is_used[std::size_t(find(number[std::size_t(t[0])]))] = 1;
  row.components = int(std::count(is_used.begin(), is_used.end(), 1));
  return row;
}

}  // namespace ctpm::fidelity
