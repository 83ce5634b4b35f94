#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cutbody/cut_grid.h"
#include "core/cutbody/sight.h"

namespace ctpm::cutbody {

/// The spheres that a place in cut tissue is joined to, each by a part that changes smoothly along the cut: a sphere
/// that counts for one place and not for the next would tear the surface between them. (Weights that fall with the way
/// around the end of a cut: the diffraction method of Organ, Fleming, Terry and Belytschko, "Continuous meshless
/// approximations for nonconvex bodies by diffraction and transparency", 1996; here of ways along a grid.)
class JoinedSpheres {
 public:
  using Index = CutGrid::Index;

  struct Joined {
    Index sphere;
    double part;  ///< 1: without going around a cut's end; down to 0
  };

  /// The nodes of a place's own side that say what it is joined to are at most so many edges away; what those see may
  /// depend on edges so far away.
  static constexpr Index kBlurHops = 2, kMostHops = Sight::kMostHops + kBlurHops;

  /// `grid` must outlive the JoinedSpheres.
  explicit JoinedSpheres(const CutGrid& grid) : grid_(grid), sight_(grid) {}

  /// Follows the grid, of which edges or spheres in a box have changed.
  void update(CutGrid::NodeBox changed) { sight_.update(changed); }

  /// Whether a cut is so near to a node in tissue that it may part it from spheres.
  bool is_near_cut(Index side) const { return sight_.has_cut(side); }

  /// Goes to a place at rest [m] on the side of a node in tissue at most sqrt(3) steps of the grid away: all below is
  /// asked of it.
  void go_to(Vec3 rest, Index side);
  /// How far the place is joined to a sphere; 0: not at all.
  double part_of(Index sphere);
  /// The spheres that are joined and less than `reach` [m] from `centre` at rest, ascending. Valid until the next call.
  std::span<const Joined> within(Vec3 centre, double reach);

  /// Number of calls of update().
  std::uint32_t round() const { return sight_.round(); }
  struct Weighted {
    Index node;
    double weight;
  };
  /// The nodes of the place's own side that say what it is joined to, and how much each counts.
  std::span<const Weighted> weighted_nodes() const { return nodes_; }
  /// The nodes on which, and on the edges of which, it depends what the place is joined to.
  std::vector<Index> nodes() const;
  /// Whether nodes have the edges, and see what they saw, in a round.
  bool is_as_in(std::uint32_t round, std::span<const Index> nodes) const;

 private:
  void find_nodes(Vec3 rest, Index side);

  const CutGrid& grid_;
  Sight sight_;
  std::vector<Weighted> nodes_;
  std::vector<CutGrid::Node> place_;  ///< of each of them in the grid
  double total_ = 0;                  ///< of their weights
  bool is_parted_ = false;            ///< a cut is near
  std::vector<Joined> joined_;
};

}  // namespace ctpm::cutbody
