#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/cutbody/cut_grid.h"

namespace ctpm::cutbody {

/// What the nodes of a grid see of each other along its edges, around which no surface goes. A row of nodes along the
/// grid's first axis is a row of bits, so that all ways along a row are followed at once.
class Sight {
 public:
  using Index = CutGrid::Index;

  /// Spheres are seen over this many edges at most, and over so many more than the shortest way: what can only be
  /// reached around the end of a cut is on its other side.
  static constexpr Index kMostHops = 12, kMostDetour = 4;

  struct Seen {
    struct Sphere {
      Index sphere, detour;  ///< edges of the way to it beyond the shortest
      friend bool operator==(const Sphere&, const Sphere&) = default;
    };
    std::vector<Sphere> sphere;  ///< ascending
    bool has_cut = false;  ///< an edge that a cut crosses begins or ends at a node fewer edges away than kMostHops
    friend bool operator==(const Seen&, const Seen&) = default;
  };

  /// `grid` must outlive the Sight.
  explicit Sight(const CutGrid& grid);

  /// Follows the grid, of which edges or spheres in a box have changed.
  void update(CutGrid::NodeBox changed);

  /// What a node sees.
  Seen from(Index node);

 private:
  static constexpr Index kSide = 2 * kMostHops + 1;
  /// The nodes around one: a bit for each along the first axis.
  using Row = std::uint32_t;
  using Rows = std::array<Row, std::size_t(kSide* kSide)>;
  /// A bit for each node, in rows that begin and end with kMostHops bits beside the grid.
  using Bits = std::vector<std::uint64_t>;

  std::size_t word(CutGrid::Node n) const {
    return words_ * (std::size_t(n[1]) + std::size_t(grid_.extent()[1]) * std::size_t(n[2])) +
           std::size_t(n[0] + kMostHops) / 64;
  }
  static std::uint64_t bit(CutGrid::Node n) { return std::uint64_t(1) << (std::size_t(n[0] + kMostHops) % 64); }
  void set(Bits& bits, CutGrid::Node n, bool value) {
    std::uint64_t& w = bits[word(n)];
    w = value ? w | bit(n) : w & ~bit(n);
  }
  Row row_at(const Bits& bits, CutGrid::Node home, Index j, Index k) const;
  void add_spheres(CutGrid::Node home, Index hops, Index j, Index k, Row row, Seen& seen) const;

  const CutGrid& grid_;
  std::size_t words_;  ///< of a row
  std::array<Bits, CutGrid::kDirections>
      is_open_;  ///< of edges, at their lower nodes: both ends are in the same tissue
  Bits at_cut_;  ///< a cut crosses an edge of the node
  Bits has_sphere_;
};

}  // namespace ctpm::cutbody
