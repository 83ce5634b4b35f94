#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/cutbody/torn_tissue.h"
#include "core/cutting/rest_map.h"
#include "core/cutting/swept_surface.h"
#include "core/cutting/tissue_depth.h"
#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::cutbody {

/// A grid over an organ at rest, four times as fine as its lattice, whose cubes are divided into six tetrahedra each
/// (Kuhn 1960). It knows which of its nodes are in tissue, where its edges leave the organ, where the swept surface
/// crosses them, and where tissue that the cuts leave without elements tears.
class CutGrid {
 public:
  using Index = std::int32_t;
  using Node = std::array<Index, 3>;

  static constexpr int kPerSpacing = 4;
  /// Edges from a node: to the nodes that are farther by 1 along the axes of the bits set in 1 to 7.
  static constexpr int kDirections = 8;

  /// An organ that has a surface. `model` must outlive the CutGrid.
  CutGrid(const Model& model, std::size_t organ);

  /// Follows the swept surface of `state`. Returns whether any edge's crossing changed. Fast where the State goes on
  /// from that of the last call.
  bool update(const State& state);
  bool anything_cut() const { return anything_cut_; }

  Index organ() const { return organ_; }
  Index count() const { return Index(in_tissue_.size()); }
  const Node& extent() const { return extent_; }
  double step() const { return step_; }
  Index at(Node n) const { return n[0] + extent_[0] * (n[1] + extent_[1] * n[2]); }
  Node node(Index i) const { return {i % extent_[0], i / extent_[0] % extent_[1], i / extent_[0] / extent_[1]}; }
  bool contains(Node n) const {
    return n[0] >= 0 && n[1] >= 0 && n[2] >= 0 && n[0] < extent_[0] && n[1] < extent_[1] && n[2] < extent_[2];
  }
  Vec3 rest(Index i) const { return place(node(i)); }
  /// Where a node is at rest, of the grid or beyond it [m].
  Vec3 place(Node n) const { return origin_ + step_ * (n[0] * axis_[0] + n[1] * axis_[1] + n[2] * axis_[2]); }
  bool in_tissue(Index i) const { return in_tissue_[std::size_t(i)] != 0; }

  /// The node at the other end of an edge.
  Index end(Index node, int direction) const {
    return node + (direction & 1) + extent_[0] * ((direction >> 1 & 1) + extent_[1] * (direction >> 2));
  }
  /// Calls `visit(to, lower, direction)` for each edge from a node to another of the grid, which belongs to its lower
  /// node.
  template <class Visit>
  void for_each_edge(Index from, Visit&& visit) const {
    const Node n = node(from);
    for (int d = 1; d < kDirections; ++d) {
      const Node up{n[0] + (d & 1), n[1] + (d >> 1 & 1), n[2] + (d >> 2)},
          down{n[0] - (d & 1), n[1] - (d >> 1 & 1), n[2] - (d >> 2)};
      if (contains(up)) visit(at(up), from, d);
      if (contains(down)) visit(at(down), at(down), d);
    }
  }
  /// Whether the surface of the organ or of the cut crosses an edge, or tissue is torn across it.
  bool is_parted(Index node, int direction) const { return (parted_[std::size_t(node)] >> direction & 1) != 0; }
  bool is_torn(Index node, int direction) const { return torn_.contains(edge(node, direction)); }
  struct Crossing {
    double along;  ///< from 0 at the lower node to 1
    Vec3 normal;   ///< of any length
  };
  /// The triangle of the organ's own surface that is nearest to a place at rest near it; -1: none is near.
  Index nearest_triangle(Vec3 rest) const { return depth_.nearest_triangle(std::size_t(organ_), rest); }
  /// Where the organ's own surface crosses an edge that leaves the tissue.
  Crossing outer_crossing(Index node, int direction) const;
  /// The crossing of an edge with the swept surface that is nearest to its lower node or to its upper one, for it may
  /// cross more than once; none if it does not.
  std::optional<Crossing> cut_crossing(Index node, int direction, bool nearest_to_upper) const;
  bool is_severed(Index node, int direction) const {
    return is_parted(node, direction) && in_tissue(node) && in_tissue(end(node, direction));
  }

  /// The node in tissue at a sphere, or the fewest edges from it on its side of the cut; -1 if there is none near.
  /// Counted within the organ.
  Index home_of_sphere(Index sphere) const { return home_[std::size_t(sphere)]; }
  /// The same; -1 also if the sphere carries no tissue (TornTissue).
  Index node_of_sphere(Index sphere) const { return node_of_sphere_[std::size_t(sphere)]; }
  Index sphere_count() const { return Index(node_of_sphere_.size()); }
  /// Whether a sphere is in tissue itself.
  bool is_inside(Index sphere) const { return in_tissue(own_node_[std::size_t(sphere)]); }
  /// The nodes at the corners of the cube that a place at rest is in, without those beyond the grid.
  std::vector<Index> corners_around(Vec3 rest) const;
  /// Blocks of a lattice cell's size divide the grid: that of a node, or of the cube above it.
  Index block_count() const { return blocks_[0] * blocks_[1] * blocks_[2]; }
  Index block(Index node) const {
    const Node n = this->node(node);
    return n[0] / kPerSpacing + blocks_[0] * (n[1] / kPerSpacing + blocks_[1] * (n[2] / kPerSpacing));
  }
  /// The lowest node of a block.
  Node first_node(Index block) const {
    return {kPerSpacing * (block % blocks_[0]), kPerSpacing * (block / blocks_[0] % blocks_[1]),
            kPerSpacing * (block / blocks_[0] / blocks_[1])};
  }
  /// The block that a place at rest is in; -1: none.
  Index block_at(Vec3 rest) const;
  /// Number of blocks along each axis in the grid of an organ that has a surface.
  static Node blocks_of(const Model& model, std::size_t organ);
  /// Marks the blocks of cut edges (block_count).
  std::vector<std::uint8_t> cut_blocks() const;
  /// Marks the blocks around those that are marked, too.
  std::vector<std::uint8_t> widened(const std::vector<std::uint8_t>& blocks) const;

  /// Numbers the pieces of tissue: for each node the lowest node of its piece; -1 outside.
  std::vector<Index> find_pieces() const;

  /// Calls `visit(sphere)` for the spheres of the organ less than `reach` [m] from a place at rest [m], in any order.
  template <class Visit>
  void for_each_sphere_within(Vec3 rest, double reach, Visit&& visit) const {
    map_.for_each_within(std::size_t(organ_), rest, reach, [&](Index sphere) {
      if (norm(model_.rest_position[std::size_t(sphere)] - rest) < reach)
        visit(sphere - model_.organs[std::size_t(organ_)].first);
    });
  }

  /// Box of the nodes whose edges' crossings changed since the last call of this; empty if low > high.
  struct NodeBox {
    Node low, high;
    void add(Node n);
    bool is_empty() const { return low[0] > high[0]; }
  };
  NodeBox take_changed();
  /// Whether the cube at a node has a node in a box.
  bool touches(const NodeBox& box, Node cube) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (cube[a] + 1 < box.low[a] || cube[a] > box.high[a]) return false;
    return true;
  }
  /// Whether a node is at most so many edges from a box.
  bool is_near(const NodeBox& box, Index node, Index hops) const {
    const Node n = this->node(node);
    for (std::size_t a = 0; a < 3; ++a)
      if (n[a] < box.low[a] - hops || n[a] > box.high[a] + hops) return false;
    return true;
  }

 private:
  Vec3 normal_of(Index triangle) const;
  std::size_t edge(Index node, int direction) const { return std::size_t(node) * kDirections + std::size_t(direction); }
  void find_frame(const Model& model, const OrganRange& organ);
  void find_surface();
  void place_spheres(const Model& model, const OrganRange& organ);
  struct Cut {
    float low, high;  ///< crossings nearest to the lower and to the upper node
    Vec3 normal_low, normal_high;
  };
  Index find_home(Index sphere) const;
  void find_homes_outside();
  void sever_row(const State& state, std::size_t row);
  void sever(Vec3 a, Vec3 b, Vec3 c, bool outside, bool may_move);
  void sever_outside(Index node, int direction, bool may_move);
  void sever_edge(Index node, int direction, float along, Vec3 normal, bool may_move);
  void take_back_last_row();
  void tear(const State& state);
  void move_strays(const std::vector<TornTissue::Tear::Stray>& strays);
  void part(std::size_t edge, Vec3 normal);
  void join(std::size_t edge);
  void reset();

  const Model& model_;
  std::int32_t organ_;
  cutting::RestMap map_;
  cutting::TissueDepth depth_;
  double step_ = 0;
  Vec3 origin_, axis_[3];  ///< of node 0 0 0 [m]; unit vectors
  Node extent_{}, blocks_{};
  LatticeCell first_cell_{};  ///< lowest cell of the lattice that the grid covers, a spacing inside it
  std::vector<std::uint8_t> in_tissue_;
  std::vector<std::uint8_t> parted_;  ///< of each node: a bit for each direction
  struct Outer {
    float along;
    /// The triangle that crosses it, once it was asked for; -1: none is near. Read and written as an atomic: threads
    /// that find it find the same.
    mutable Index triangle = kUnknown;
  };
  static constexpr Index kUnknown = -2;
  std::unordered_map<std::size_t, Outer> outer_;  ///< crossings of edges with the organ's surface
  std::unordered_map<std::size_t, Cut> cuts_;
  /// Edges that the swept surface crosses outside the tissue, where it goes on among the spheres there.
  std::unordered_set<std::size_t> outside_;
  TornTissue torn_tissue_;
  std::unordered_set<std::size_t> torn_;  ///< edges across which tissue is torn, which have crossings in their middle
  std::vector<Index> own_node_;           ///< the node where a sphere is
  std::vector<Index> home_, node_of_sphere_;
  std::size_t rows_ = 0;                                             ///< of the swept surface that have been looked at
  cutting::Front last_{};                                            ///< the last of them, which may still move [m]
  cutting::Front before_{};                                          ///< the one before it [m]
  std::vector<std::pair<std::size_t, std::optional<Cut>>> by_last_;  ///< what the last row changed, as it was before
  std::vector<std::size_t> outside_by_last_;
  bool anything_cut_ = false, changed_ = false;
  NodeBox box_{}, last_box_{};  ///< of what changed, and of what the last row swept
};

}  // namespace ctpm::cutbody
