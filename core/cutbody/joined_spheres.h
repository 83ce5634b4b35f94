#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
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
  /// Forgets all: it is found again when it is asked for.
  void forget() { seen_ = {}; }

  /// Whether a cut is so near to a node in tissue that it may part it from spheres.
  bool is_near_cut(Index side) { return seen_from(side).has_cut; }

  /// The spheres of a place at rest [m] on the side of a node in tissue at most sqrt(3) steps of the grid away,
  /// ascending. Valid until the next call.
  std::span<const Joined> around(Vec3 rest, Index side);

  /// Number of calls of update().
  std::uint32_t round() const { return sight_.round(); }
  struct Weighted {
    Index node;
    double weight;
  };
  /// The nodes of the place's own side that said so in the last call of around(), and how much each counted.
  std::span<const Weighted> weighted_nodes() const { return nodes_; }
  /// The nodes on which, and on the edges of which, the result of the last call of around() depends.
  std::vector<Index> nodes() const;
  /// Whether nodes have the edges, and see what they saw, in a round.
  bool is_as_in(std::uint32_t round, std::span<const Index> nodes) const;

 private:
  struct Known {
    Sight::Seen seen;
    std::uint32_t round = 0;  ///< in which it was seen
  };
  void find_nodes(Vec3 rest, Index side);
  const Sight::Seen& seen_from(Index node);

  const CutGrid& grid_;
  Sight sight_;
  std::unordered_map<Index, Known> seen_;
  std::vector<Weighted> nodes_;
  static constexpr std::size_t kWord = 64;
  std::vector<double> sum_;              ///< of each sphere; 0 between calls
  std::vector<std::uint64_t> is_known_;  ///< a bit for each sphere of which the sum is not 0
  std::vector<Joined> joined_;
};

}  // namespace ctpm::cutbody
