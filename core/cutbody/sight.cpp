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

/// For each row around a node, and each number of edges, the nodes to which the shortest way has so many.
using Shortest = std::array<std::uint32_t, Sight::kMostHops + 1>;
std::vector<Shortest> shortest_ways() {
  constexpr CutGrid::Index kMost = Sight::kMostHops;
  std::vector<Shortest> ways;
  for (CutGrid::Index k = -kMost; k <= kMost; ++k)
    for (CutGrid::Index j = -kMost; j <= kMost; ++j) {
      Shortest& row = ways.emplace_back();
      for (CutGrid::Index i = -kMost; i <= kMost; ++i)
        if (const CutGrid::Index way = shortest_way({i, j, k}); way <= kMost)
          row[std::size_t(way)] |= std::uint32_t(1) << (i + kMost);
    }
  return ways;
}

CutGrid::Node end_of(CutGrid::Node n, int direction) {
  return {n[0] + (direction & 1), n[1] + (direction >> 1 & 1), n[2] + (direction >> 2)};
}

}  // namespace

Sight::Sight(const CutGrid& grid)
    : grid_(grid),
      rows_(grid.extent()[1] + 2 * kBeside),
      layers_(grid.extent()[2] + 2 * kBeside),
      windows_((grid.extent()[0] - 1) / kStride + 1) {
  const auto size = std::size_t(rows_) * std::size_t(layers_) * std::size_t(windows_);
  for (Bits& open : is_open_) open.assign(size, 0);
  at_cut_.assign(size, 0), beside_cut_.assign(size, 0), has_sphere_.assign(size, 0);
  changed_in_.assign(std::size_t(grid.count()), 0);
  find_edges({{0, 0, 0}, grid.extent()});
  find_beside_cut({{0, 0, 0}, grid.extent()});
  find_spheres();
}

void Sight::find_spheres() {
  node_of_sphere_.clear();
  for (Index s = 0; s < grid_.sphere_count(); ++s) node_of_sphere_.push_back(grid_.node_of_sphere(s));
  view_.resize(node_of_sphere_.size());
}

/// In each window that the node is in.
void Sight::set(Bits& bits, CutGrid::Node n, bool value) {
  const Index along = n[0] + kMostHops, last = std::min(along / kStride, windows_ - 1);
  for (Index w = std::max(0, (along - kWindow + kStride) / kStride); w <= last; ++w) {
    Row& row = bits[at(w, n[1], n[2])];
    const Row bit = Row(1) << (along - kStride * w);
    row = value ? row | bit : row & ~bit;
  }
}

void Sight::update(CutGrid::NodeBox changed) {
  ++round_;
  find_edges(changed);
  find_beside_cut(changed);
  if (changed.low == CutGrid::Node{} && changed.high == grid_.extent()) {
    // Anything may have changed: it is found again when it is asked for.
    view_.clear(), changed_in_.assign(changed_in_.size(), round_);
  }
  for (std::size_t s = 0; s < view_.size(); ++s)
    if (node_of_sphere_[s] != grid_.node_of_sphere(Index(s)) ||
        (view_[s] && grid_.is_near(changed, view_[s]->node, kMostHops + 1)))
      look_again(Index(s));
  find_spheres();
}

/// Finds the edges in a box again that may be gone along, and what is at their ends.
void Sight::find_edges(CutGrid::NodeBox changed) {
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
      const bool is_open = is_edge && !grid_.is_parted(node, d);
      if (is_open != is_set(is_open_[std::size_t(d)], n))
        set(is_open_[std::size_t(d)], n, is_open), mark(node), mark(grid_.end(node, d));
      at_cut = at_cut || is_cut(n, d) || is_cut({n[0] - (d & 1), n[1] - (d >> 1 & 1), n[2] - (d >> 2)}, d);
    }
    set(at_cut_, n, at_cut), set(has_sphere_, n, !grid_.spheres_at(node).empty());
  });
}

/// Adds what is reached over an edge from the nodes of `last` to a run of rows, the first of which is at `first` in the
/// windows; `layer`: rows of `last` from one layer to the next.
void Sight::arrive(std::size_t first, const Row* last, Index layer, std::span<Row> found) const {
  for (int d = 1; d < CutGrid::kDirections; ++d) {
    const int dx = d & 1, dy = d >> 1 & 1, dz = d >> 2;
    const Row *below = last - (dy + layer * dz), *above = last + (dy + layer * dz);
    const Row *open = &is_open_[std::size_t(d)][first], *open_below = open - (dy + rows_ * dz);
    for (std::size_t j = 0; j < found.size(); ++j)
      found[j] |= (below[j] & open_below[j]) << dx | (above[j] >> dx & open[j]);
  }
}

/// Finds what is reached over `hops` edges and not over fewer.
void Sight::go_on(CutGrid::Node home, Index hops, const Rows& last, Rows& visited, Rows& next) const {
  for (Index k = -hops; k <= hops; ++k) {
    std::array<Row, std::size_t(kRows)> found{};
    const auto count = std::size_t(2 * hops + 1), to = around(-hops, k);
    arrive(at(window(home), home[1] - hops, home[2] + k), &last[to], kRows, std::span(found).first(count));
    for (std::size_t j = 0; j < count; ++j) next[to + j] = found[j] & ~visited[to + j], visited[to + j] |= found[j];
  }
}

/// Finds the nodes again from which an edge across a cut is fewer edges away than are seen along, where edges in a box
/// have changed.
void Sight::find_beside_cut(CutGrid::NodeBox changed) {
  CutGrid::Node low, high, first, last;
  for (std::size_t a = 0; a < 3; ++a) {
    const Index end = grid_.extent()[a] - 1;
    low[a] = std::max(0, changed.low[a] - kMostHops), high[a] = std::min(end, changed.high[a] + kMostHops);
    first[a] = std::max(0, low[a] - kMostHops), last[a] = std::min(end, high[a] + kMostHops);
  }
  const Index rows = last[1] - first[1] + 1, layer = rows + 2;
  const auto row = [&](Index k) { return std::size_t(1 + layer * (k - first[2] + 1)); };
  std::vector<Row> reached(row(last[2] + 2)), before;
  for (Index w = window(low); w <= window(high); ++w) {
    std::fill(reached.begin(), reached.end(), 0);
    for (Index k = first[2]; k <= last[2]; ++k)
      std::copy_n(at_cut_.begin() + std::ptrdiff_t(at(w, first[1], k)), rows, reached.begin() + std::ptrdiff_t(row(k)));
    for (Index hops = 1; hops < kMostHops; ++hops) {
      before = reached;
      for (Index k = first[2]; k <= last[2]; ++k)
        arrive(at(w, first[1], k), &before[row(k)], layer, {&reached[row(k)], std::size_t(rows)});
    }
    constexpr Row kNodes = ((Row(1) << kStride) - 1) << kMostHops;
    for (Index k = low[2]; k <= high[2]; ++k)
      for (Index j = low[1]; j <= high[1]; ++j) {
        const Row now = reached[row(k) + std::size_t(j - first[1])];
        const Row before_now = std::exchange(beside_cut_[at(w, j, k)], now);
        for (Row other = (now ^ before_now) & kNodes; other != 0; other &= other - 1)
          if (const CutGrid::Node n{kStride * w + std::countr_zero(other) - kMostHops, j, k}; grid_.contains(n))
            mark(grid_.at(n));
      }
  }
}

const Sight::View& Sight::view_of(Index sphere, Index node) {
  std::unique_ptr<View>& known = view_[std::size_t(sphere)];
  if (!known) known = look_from(node);
  return *known;
}

/// Follows the grid with the view of a sphere, and marks the nodes that see it otherwise than before.
void Sight::look_again(Index sphere) {
  std::unique_ptr<View>& known = view_[std::size_t(sphere)];
  const Index node = grid_.node_of_sphere(sphere);
  std::unique_ptr<View> view = node < 0 ? nullptr : look_from(node);
  if (view && known && view->node == known->node) {
    mark_changes(known.get(), view.get());
  } else {
    if (known) mark_changes(known.get(), nullptr);
    if (view) mark_changes(nullptr, view.get());
  }
  known = std::move(view);
}

/// Marks the nodes in which two views from one node differ; null: one that sees nothing.
void Sight::mark_changes(const View* before, const View* after) {
  const CutGrid::Node home = grid_.node((before != nullptr ? before : after)->node);
  for (std::size_t r = 0; r < View{}.detour.size(); ++r) {
    Row other = 0;
    for (std::size_t b = 0; b < std::size_t(View::kBits); ++b)
      other |= (before != nullptr ? before->detour[r][b] : 0) ^ (after != nullptr ? after->detour[r][b] : 0);
    for (; other != 0; other &= other - 1)
      mark(grid_.at({home[0] + std::countr_zero(other) - kMostHops, home[1] + Index(r) % kSide - kMostHops,
                     home[2] + Index(r) / kSide - kMostHops}));
  }
}

std::unique_ptr<Sight::View> Sight::look_from(Index node) const {
  auto made = std::make_unique<View>();
  View& view = *made;
  view.node = node;
  const CutGrid::Node home = grid_.node(node);
  std::array<Rows, kMostHops + 1> reached{};
  Rows visited{};
  visited[around(0, 0)] = reached[0][around(0, 0)] = Row(1) << bit(home);
  for (Index hops = 1; hops <= kMostHops; ++hops)
    go_on(home, hops, reached[std::size_t(hops) - 1], visited, reached[std::size_t(hops)]);
  static const std::vector<Shortest> shortest = shortest_ways();
  for (std::size_t r = 0; r < view.detour.size(); ++r) {
    const Index j = Index(r) % kSide - kMostHops, k = Index(r) / kSide - kMostHops;
    view.detour[r] = {};
    for (Index way = shortest_way({0, j, k}); way <= kMostHops; ++way)
      for (Index longer = 0; longer <= std::min(kGrazed + kMostDetour, kMostHops - way); ++longer) {
        const Row seen =
            reached[std::size_t(way + longer)][around(j, k)] >> (bit(home) - kMostHops) & shortest[r][std::size_t(way)];
        const Index detour = std::max(0, longer - kGrazed);
        for (int b = 0; b < View::kBits; ++b)
          if ((1 + detour) >> b & 1) view.detour[r][std::size_t(b)] |= seen;
      }
  }
  return made;
}

Sight::Seen Sight::from(Index node) {
  const CutGrid::Node home = grid_.node(node);
  Seen seen;
  seen.has_cut = (beside_cut_[at(window(home), home[1], home[2])] >> bit(home) & 1) != 0;
  for (Index k = -kMostHops; k <= kMostHops; ++k)
    for (Index j = -kMostHops; j <= kMostHops; ++j) {
      const Row spheres = has_sphere_[at(window(home), home[1] + j, home[2] + k)] >> (bit(home) - kMostHops);
      for (Row row = spheres & ((Row(1) << kSide) - 1); row != 0; row &= row - 1) {
        const Index i = std::countr_zero(row) - kMostHops;
        const Index there = grid_.at({home[0] + i, home[1] + j, home[2] + k});
        for (const Index sphere : grid_.spheres_at(there)) {
          // The way from the sphere is the way to it.
          const auto& bits = view_of(sphere, there).detour[std::size_t(kMostHops - j + kSide * (kMostHops - k))];
          Index detour = 0;
          for (int b = 0; b < View::kBits; ++b) detour |= Index(bits[std::size_t(b)] >> (kMostHops - i) & 1) << b;
          if (detour > 0) seen.sphere.push_back({sphere, detour - 1});
        }
      }
    }
  std::sort(seen.sphere.begin(), seen.sphere.end(),
            [](const Seen::Sphere& a, const Seen::Sphere& b) { return a.sphere < b.sphere; });
  return seen;
}

}  // namespace ctpm::cutbody
