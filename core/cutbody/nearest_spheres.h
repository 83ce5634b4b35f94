#pragma once

#include <cstdint>
#include <vector>

#include "core/cutbody/cut_grid.h"

namespace ctpm::cutbody {

/// For each node of a cut grid near a cut, the sphere that is the fewest edges away in whole tissue: at the rim of a
/// wedge no sphere may be in sight, while those across the cut are near.
class NearestSpheres {
 public:
  using Index = CutGrid::Index;

  /// Spheres farther away than so many edges are not found.
  static constexpr Index kMostHops = 24;

  struct Near {
    Index sphere = -1;  ///< -1: none is near
    Index hops = 0;
  };

  /// `grid` must outlive the NearestSpheres.
  explicit NearestSpheres(const CutGrid& grid) : grid_(grid) {}

  /// The grid has changed.
  void forget() { near_.clear(); }
  /// Of several spheres that are as near, any, but always the same one.
  Near of(Index node) {
    if (near_.empty()) find();
    return near_[std::size_t(node)];
  }

 private:
  void find();

  const CutGrid& grid_;
  std::vector<Near> near_;  ///< of each node; empty until it is asked for
};

}  // namespace ctpm::cutbody
