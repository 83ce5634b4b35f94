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

Sight::Sight(const CutGrid& grid)
    : grid_(grid),
      rows_(grid.extent()[1] + 2 * kBeside),
      layers_(grid.extent()[2] + 2 * kBeside),
      windows_((grid.extent()[0] - 1) / kStride + 1) {
  const auto size = std::size_t(rows_) * std::size_t(layers_) * std::size_t(windows_);
  for (Bits& open : is_open_) open.assign(size, 0);
  at_cut_.assign(size, 0), beside_cut_.assign(size, 0);
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
  ++round_, changed_.clear();
  if (!changed.is_empty()) find_edges(changed), find_beside_cut(changed);
  if (changed.low == CutGrid::Node{} && changed.high == grid_.extent()) {
    // Anything may have changed: it is found again when it is asked for.
    view_.clear(), changed_in_.assign(changed_in_.size(), round_);
  }
  for (std::size_t s = 0; s < view_.size(); ++s)
    if (node_of_sphere_[s] != grid_.node_of_sphere(Index(s)) ||
        (view_[s] && grid_.is_near(changed, view_[s]->node_, kMostHops + 1) && sees_changes(*view_[s])))
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
        set(is_open_[std::size_t(d)], n, is_open), mark_edges(node), mark_edges(grid_.end(node, d));
      at_cut = at_cut || is_cut(n, d) || is_cut({n[0] - (d & 1), n[1] - (d >> 1 & 1), n[2] - (d >> 2)}, d);
    }
    set(at_cut_, n, at_cut);
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

/// Finds what is reached over `hops` edges and not over fewer. Returns whether anything is.
bool Sight::go_on(CutGrid::Node home, Index hops, const Rows& last, Rows& visited, Rows& next) const {
  Row any = 0;
  for (Index k = -hops; k <= hops; ++k) {
    std::array<Row, std::size_t(kRows)> found{};
    const auto count = std::size_t(2 * hops + 1), to = around(-hops, k);
    arrive(at(window(home), home[1] - hops, home[2] + k), &last[to], kRows, std::span(found).first(count));
    for (std::size_t j = 0; j < count; ++j) {
      next[to + j] = found[j] & ~visited[to + j], visited[to + j] |= found[j];
      any |= next[to + j];
    }
  }
  return any != 0;
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

const Sight::View* Sight::view_of(Index sphere) {
  std::unique_ptr<View>& known = view_[std::size_t(sphere)];
  const Index node = node_of_sphere_[std::size_t(sphere)];
  if (!known && node >= 0) known = look_from(node);
  return known.get();
}

/// Whether a way of a view may go along an edge that changed. No way to what is seen goes by what is not: a way is
/// never less of a detour than its beginning.
bool Sight::sees_changes(const View& view) const {
  return std::any_of(changed_.begin(), changed_.end(), [&](Index node) { return view.detour(grid_.node(node)) >= 0; });
}

/// Follows the grid with the view of a sphere, and marks the nodes that see it otherwise than before.
void Sight::look_again(Index sphere) {
  std::unique_ptr<View>& known = view_[std::size_t(sphere)];
  const Index node = grid_.node_of_sphere(sphere);
  std::unique_ptr<View> view = node < 0 ? nullptr : look_from(node);
  if (view && known && view->node_ == known->node_) {
    mark_changes(known.get(), view.get());
  } else {
    if (known) mark_changes(known.get(), nullptr);
    if (view) mark_changes(nullptr, view.get());
  }
  known = std::move(view);
}

/// Marks the nodes in which two views from one node differ; null: one that sees nothing.
void Sight::mark_changes(const View* before, const View* after) {
  const CutGrid::Node low = (before != nullptr ? before : after)->low_;
  for (std::size_t r = 0; r < std::size_t(kSide * kSide); ++r) {
    Row other = 0;
    for (std::size_t b = 0; b < std::size_t(kBits); ++b)
      other |= (before != nullptr ? before->number_[r][b] : 0) ^ (after != nullptr ? after->number_[r][b] : 0);
    for (; other != 0; other &= other - 1)
      mark(grid_.at({low[0] + std::countr_zero(other), low[1] + Index(r) % kSide, low[2] + Index(r) / kSide}));
  }
}

/// For each number of edges of a way, and each row around a node, the bits of View::number_ of nodes to which such a
/// way is short enough.
const std::vector<Sight::Numbers>& Sight::seen_over() {
  static const std::vector<Numbers> all = [] {
    std::vector<Numbers> made(std::size_t(kMostHops) + 1);
    for (Index k = 0; k < kSide; ++k)
      for (Index j = 0; j < kSide; ++j)
        for (Index i = 0; i < kSide; ++i) {
          const Index shortest = shortest_way({i - kMostHops, j - kMostHops, k - kMostHops});
          for (Index longer = 0; longer <= std::min(kGrazed + kMostDetour, kMostHops - shortest); ++longer) {
            const Index number = 1 + std::max(0, longer - kGrazed);
            for (int b = 0; b < kBits; ++b)
              if (number >> b & 1)
                made[std::size_t(shortest + longer)][std::size_t(j + kSide * k)][std::size_t(b)] |= Row(1) << i;
          }
        }
    return made;
  }();
  return all;
}

std::unique_ptr<Sight::View> Sight::look_from(Index node) const {
  auto made = std::make_unique<View>();
  View& view = *made;
  const CutGrid::Node home = grid_.node(node);
  view.node_ = node, view.low_ = {home[0] - kMostHops, home[1] - kMostHops, home[2] - kMostHops};
  const Index shift = bit(home) - kMostHops;
  Rows visited{}, last{}, next{};
  visited[around(0, 0)] = last[around(0, 0)] = Row(1) << bit(home);
  for (Index hops = 0;; ++hops) {
    const Numbers& seen = seen_over()[std::size_t(hops)];
    for (Index k = -hops; k <= hops; ++k)
      for (Index j = -hops; j <= hops; ++j) {
        const auto r = std::size_t(j + kMostHops + kSide * (k + kMostHops));
        const Row reached = last[around(j, k)] >> shift;
        for (std::size_t b = 0; b < seen[r].size(); ++b) view.number_[r][b] |= reached & seen[r][b];
      }
    if (hops == kMostHops || !go_on(home, hops + 1, last, visited, next)) return made;
    std::swap(last, next);
  }
}

}  // namespace ctpm::cutbody
