#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cutbody/cut_grid.h"

namespace ctpm::cutbody {

/// For each node of a cut grid near a cut, spheres that are the fewest edges away in whole tissue, apart from each
/// other: at the rim of a wedge no sphere may be in sight, while those across the cut are near; and a strip between two
/// cuts hangs between spheres that are far from each other.
class NearestSpheres {
 public:
  using Index = CutGrid::Index;

  /// Spheres farther away than so many edges are not found.
  static constexpr Index kMostHops = 24;
  /// Of each node at most so many, each farther than kApart spacings from the others at rest.
  static constexpr std::size_t kMost = 4;
  static constexpr double kApart = 3;

  struct Near {
    Index sphere = -1;
    Index hops = 0;
  };

  /// Both must outlive the NearestSpheres.
  NearestSpheres(const Model& model, const CutGrid& grid) : model_(model), grid_(grid) {}

  /// The grid has changed.
  void forget();
  /// The nearest first; of several that are as near, any, but always the same one.
  std::span<const Near> of(Index node) {
    if (!is_found_) find();
    if (number_[std::size_t(node)] < 0) return {};
    const Nears& near = near_[std::size_t(number_[std::size_t(node)])];
    return {near.sphere.data(), std::size_t(near.count)};
  }

 private:
  struct Nears {
    Index node;
    Index count = 0;
    std::array<Near, kMost> sphere{};
  };
  struct Reached {
    Index node, sphere;
  };
  void find();
  bool add(Reached reached, Index hops);
  bool is_apart(Index sphere, Index other) const;

  const Model& model_;
  const CutGrid& grid_;
  bool is_found_ = false;
  std::vector<Index> number_;  ///< of each node in near_; -1: it has none
  std::vector<Nears> near_;    ///< of the nodes that have any
};

}  // namespace ctpm::cutbody
