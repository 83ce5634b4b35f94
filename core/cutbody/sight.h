#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/cutbody/cut_grid.h"

namespace ctpm::cutbody {

/// What the nodes of a grid see of each other along its edges, around which no surface goes. A row of nodes along the
/// grid's first axis is a row of bits, so that all ways along a row are followed at once; and the ways are those from
/// the spheres, which are far fewer than the nodes that look at them.
class Sight {
 public:
  using Index = CutGrid::Index;

  /// Spheres are seen over this many edges at most, and over so many more than the shortest way: what can only be
  /// reached around the end of a cut is on its other side. So many more may be due to a wall beside the way, which
  /// grazes edges of the grid, and are no detour (our choice).
  static constexpr Index kMostHops = 12, kGrazed = 1, kMostDetour = 3;

  /// `grid` must outlive the Sight.
  explicit Sight(const CutGrid& grid);

  /// Follows the grid, of which edges or spheres in a box have changed.
  void update(CutGrid::NodeBox changed);

  /// Whether an edge that a cut crosses begins or ends at a node fewer edges away than kMostHops.
  bool has_cut(Index node) const { return is_set(beside_cut_, grid_.node(node)); }

  /// The nodes that see a sphere.
  class View;
  /// None of one that carries no tissue. Valid until the next update().
  const View* view_of(Index sphere);

  /// Number of calls of update().
  std::uint32_t round() const { return round_; }
  /// The round in which the edges of a node, has_cut() of it, or what it sees of a sphere for which view_of() was asked
  /// before, changed last.
  std::uint32_t changed_in(Index node) const { return changed_in_[std::size_t(node)]; }

 private:
  /// Nodes in a row along the first axis, a bit for each.
  using Row = std::uint32_t;
  static constexpr Index kSide = 2 * kMostHops + 1;  ///< of those that may be seen, along each axis
  /// Windows of so many nodes begin every 8 nodes of a row, kMostHops before the grid's first: so one of them has all
  /// that a node may see along its row.
  static constexpr Index kWindow = 32, kStride = 8;
  static_assert(kSide + kStride - 1 <= kWindow);
  /// There are so many empty rows beside the grid.
  static constexpr Index kBeside = kMostHops + 1;
  /// A bit for each node: the rows of a window lie next to each other along the second axis.
  using Bits = std::vector<Row>;
  /// Rows around one, and an empty one on each side.
  static constexpr Index kRows = 2 * kBeside + 1;
  using Rows = std::array<Row, std::size_t(kRows* kRows)>;
  static std::size_t around(Index j, Index k) { return std::size_t(j + kBeside + kRows * (k + kBeside)); }

  /// A number of three bits for each node that may be seen: for each row the lowest bits, the next and the highest. One
  /// more is empty, so that a row has a vector's size.
  static constexpr int kBits = 3;
  using Numbers = std::array<std::array<Row, 4>, std::size_t(kSide* kSide)>;

  /// The window of a node and what it may see, and the node's bit in it.
  static Index window(CutGrid::Node n) { return n[0] / kStride; }
  static Index bit(CutGrid::Node n) { return n[0] % kStride + kMostHops; }
  std::size_t at(Index window, Index j, Index k) const {
    return std::size_t(j + kBeside + rows_ * (k + kBeside + layers_ * window));
  }
  bool is_set(const Bits& bits, CutGrid::Node n) const { return (bits[at(window(n), n[1], n[2])] >> bit(n) & 1) != 0; }
  void set(Bits& bits, CutGrid::Node n, bool value);
  void mark(Index node) { changed_in_[std::size_t(node)] = round_; }
  void mark_edges(Index node) { mark(node), changed_.push_back(node); }
  void find_edges(CutGrid::NodeBox changed);
  void arrive(std::size_t first, const Row* last, Index layer, std::span<Row> found) const;
  bool go_on(CutGrid::Node home, Index hops, const Rows& last, Rows& visited, Rows& next) const;
  void find_beside_cut(CutGrid::NodeBox changed);

  std::unique_ptr<View> look_from(Index node) const;
  static const std::vector<Numbers>& seen_over();
  void look_again(Index sphere);
  void find_spheres();
  bool sees_changes(const View& view) const;
  void mark_changes(const View* before, const View* after);

  const CutGrid& grid_;
  Index rows_, layers_, windows_;
  std::array<Bits, CutGrid::kDirections>
      is_open_;                              ///< of edges, at their lower nodes: both ends are in the same tissue
  Bits at_cut_;                              ///< a cut crosses an edge of the node
  Bits beside_cut_;                          ///< has_cut() of the eight nodes for which a window is
  std::vector<Index> changed_;               ///< nodes of which edges changed in this round
  std::vector<std::unique_ptr<View>> view_;  ///< of spheres; null: it is not known
  std::vector<Index> node_of_sphere_;        ///< as of the last update
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> changed_in_;  ///< of nodes: see changed_in()
};

/// Ways from the sphere to the nodes are those from them to it.
class Sight::View {
 public:
  /// Edges of the way from a node beyond the shortest and kGrazed; -1: it does not see the sphere.
  Index detour(CutGrid::Node n) const {
    const Index i = n[0] - low_[0], j = n[1] - low_[1], k = n[2] - low_[2];
    if (std::max({std::uint32_t(i), std::uint32_t(j), std::uint32_t(k)}) >= std::uint32_t(kSide)) return -1;
    const auto& row = number_[std::size_t(j + kSide * k)];
    Index number = 0;
    for (int b = 0; b < kBits; ++b) number |= Index(row[std::size_t(b)] >> i & 1) << b;
    return number - 1;
  }

 private:
  friend class Sight;
  static_assert(1 + kMostDetour < 1 << kBits);

  Index node_;
  CutGrid::Node low_;           ///< the lowest node that may be seen
  alignas(16) Numbers number_;  ///< 1 + the detour; 0: it is not seen
};

}  // namespace ctpm::cutbody
