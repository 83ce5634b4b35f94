#include "core/cutbody/sight.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/surface/surface.h"

namespace ctpm::cutbody {
namespace {

// No edge goes along the diagonal of a square from one axis to the other, so the reach of a binding takes up to sqrt(2)
// times its steps.
static_assert(Sight::kMostHops >= 1.4143 * surface::kBindingReach * CutGrid::kPerSpacing);

/// Number of edges on the shortest way to a node that is so far along the axes.
CutGrid::Index shortest_way(CutGrid::Node by) {
  CutGrid::Index up = 0, down = 0;
  for (const CutGrid::Index n : by) up = std::max(up, n), down = std::max(down, -n);
  return up + down;
}

CutGrid::Node end_of(CutGrid::Node n, int direction) {
  return {n[0] + (direction & 1), n[1] + (direction >> 1 & 1), n[2] + (direction >> 2)};
}

}  // namespace

Sight::Sight(const CutGrid& grid) : grid_(grid), words_(std::size_t(grid.extent()[0] + 2 * kMostHops + 63) / 64 + 1) {
  const std::size_t size = words_ * std::size_t(grid.extent()[1]) * std::size_t(grid.extent()[2]);
  for (Bits& open : is_open_) open.assign(size, 0);
  at_cut_.assign(size, 0), has_sphere_.assign(size, 0);
  update({{0, 0, 0}, grid.extent()});
}

void Sight::update(CutGrid::NodeBox changed) {
  // An edge belongs to its lower node, and is also the upper node's.
  CutGrid::Node low, high;
  for (std::size_t a = 0; a < 3; ++a)
    low[a] = std::max(0, changed.low[a] - 1), high[a] = std::min(grid_.extent()[a] - 1, changed.high[a] + 1);
  const auto for_each_node = [&](const auto& visit) {
    for (Index k = low[2]; k <= high[2]; ++k)
      for (Index j = low[1]; j <= high[1]; ++j)
        for (Index i = low[0]; i <= high[0]; ++i) visit(CutGrid::Node{i, j, k});
  };
  const auto is_cut = [&](CutGrid::Node lower, int d) {
    return grid_.contains(lower) && grid_.contains(end_of(lower, d)) && grid_.is_severed(grid_.at(lower), d);
  };
  for_each_node([&](CutGrid::Node n) {
    const Index node = grid_.at(n);
    bool at_cut = false;
    for (int d = 1; d < CutGrid::kDirections; ++d) {
      const bool is_edge = grid_.contains(end_of(n, d)) && grid_.in_tissue(node) && grid_.in_tissue(grid_.end(node, d));
      set(is_open_[std::size_t(d)], n, is_edge && !grid_.is_parted(node, d));
      at_cut = at_cut || is_cut(n, d) || is_cut({n[0] - (d & 1), n[1] - (d >> 1 & 1), n[2] - (d >> 2)}, d);
    }
    set(at_cut_, n, at_cut), set(has_sphere_, n, !grid_.spheres_at(node).empty());
  });
}

/// The bits of the row that is `j` and `k` nodes from `home` along the other axes, the middle one beside `home`.
Sight::Row Sight::row_at(const Bits& bits, CutGrid::Node home, Index j, Index k) const {
  const CutGrid::Node n{home[0] - kMostHops, home[1] + j, home[2] + k};
  if (n[1] < 0 || n[2] < 0 || n[1] >= grid_.extent()[1] || n[2] >= grid_.extent()[2]) return 0;
  const std::size_t first = word(n), shift = std::size_t(n[0] + kMostHops) % 64;
  std::uint64_t row = bits[first] >> shift;
  if (shift > 0) row |= bits[first + 1] << (64 - shift);
  return Row(row & ((std::uint64_t(1) << kSide) - 1));
}

/// Adds the spheres of the nodes of a row that were reached over `hops` edges.
void Sight::add_spheres(CutGrid::Node home, Index hops, Index j, Index k, Row row, Seen& seen) const {
  for (; row != 0; row &= row - 1) {
    const Index i = std::countr_zero(row) - kMostHops;
    const Index detour = hops - shortest_way({i, j, k});
    if (detour > kMostDetour) continue;
    for (const Index sphere : grid_.spheres_at(grid_.at({home[0] + i, home[1] + j, home[2] + k})))
      seen.sphere.push_back({sphere, detour});
  }
}

Sight::Seen Sight::from(Index node) {
  const CutGrid::Node home = grid_.node(node);
  const auto at = [](Index j, Index k) { return std::size_t(j + kMostHops + kSide * (k + kMostHops)); };
  // Rows of edges are asked for at each hop: once from the grid is enough.
  std::array<Rows, CutGrid::kDirections> open;
  Rows at_cut;
  for (Index k = -kMostHops; k <= kMostHops; ++k)
    for (Index j = -kMostHops; j <= kMostHops; ++j) {
      for (std::size_t d = 1; d < CutGrid::kDirections; ++d) open[d][at(j, k)] = row_at(is_open_[d], home, j, k);
      at_cut[at(j, k)] = row_at(at_cut_, home, j, k);
    }
  Seen seen;
  Rows visited{}, last{}, next{};
  visited[at(0, 0)] = last[at(0, 0)] = Row(1) << kMostHops;
  for (Index hops = 0;; ++hops) {
    for (Index k = -hops; k <= hops; ++k)
      for (Index j = -hops; j <= hops; ++j)
        if (const Row row = last[at(j, k)]; row != 0)
          add_spheres(home, hops, j, k, row & row_at(has_sphere_, home, j, k), seen);
    if (hops == kMostHops) break;
    for (Index k = -hops; k <= hops; ++k)
      for (Index j = -hops; j <= hops; ++j) {
        const Row row = std::exchange(last[at(j, k)], 0);
        if (row == 0) continue;
        seen.has_cut = seen.has_cut || (row & at_cut[at(j, k)]) != 0;
        for (int d = 1; d < CutGrid::kDirections; ++d) {
          const Index dx = d & 1, dy = d >> 1 & 1, dz = d >> 2;
          const Rows& rows = open[std::size_t(d)];
          next[at(j + dy, k + dz)] |= (row & rows[at(j, k)]) << dx;
          next[at(j - dy, k - dz)] |= row >> dx & rows[at(j - dy, k - dz)];
        }
      }
    for (Index k = -hops - 1; k <= hops + 1; ++k)
      for (Index j = -hops - 1; j <= hops + 1; ++j) {
        Row& reached = next[at(j, k)];
        last[at(j, k)] = reached & ~visited[at(j, k)];
        visited[at(j, k)] |= reached, reached = 0;
      }
  }
  std::sort(seen.sphere.begin(), seen.sphere.end(),
            [](const Seen::Sphere& a, const Seen::Sphere& b) { return a.sphere < b.sphere; });
  return seen;
}

}  // namespace ctpm::cutbody
