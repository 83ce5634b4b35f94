#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/model/model.h"
#include "core/model/organ.h"

namespace ctpm::cutbody {

/// The spheres of an organ by where they are at rest, in bins of a spacing.
class RestBins {
 public:
  using Index = std::int32_t;

  /// Both must outlive the RestBins.
  RestBins(const Model& model, const OrganRange& organ);

  /// Calls `visit(sphere)` for each sphere less than `reach` [m] from a place at rest [m], and perhaps for some at the
  /// reach. Spheres are counted within the organ.
  template <class Visit>
  void for_each_within(Vec3 rest, double reach, Visit&& visit) const {
    constexpr double kRounding = 1e-9;
    const double most = reach * (1 + kRounding);
    const Bin low = bin(rest - Vec3{most, most, most}), high = bin(rest + Vec3{most, most, most});
    for (Index k = low[2]; k <= high[2]; ++k)
      for (Index j = low[1]; j <= high[1]; ++j)
        for (Index at = first_[number({low[0], j, k})]; at < first_[number({high[0], j, k}) + 1]; ++at) {
          const Index sphere = sphere_[std::size_t(at)];
          if (norm(model_.rest_position[std::size_t(organ_.first + sphere)] - rest) < most) visit(sphere);
        }
  }

 private:
  using Bin = std::array<Index, 3>;
  Bin bin(Vec3 rest) const;
  std::size_t number(Bin b) const {
    return std::size_t(b[0]) +
           std::size_t(count_[0]) * (std::size_t(b[1]) + std::size_t(count_[1]) * std::size_t(b[2]));
  }

  const Model& model_;
  const OrganRange& organ_;
  Vec3 low_;  ///< of all spheres [m]
  Bin count_{1, 1, 1};
  std::vector<Index> first_, sphere_;  ///< of each bin, and its spheres
};

}  // namespace ctpm::cutbody
