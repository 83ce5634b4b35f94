#pragma once

#include <cstdint>
#include <vector>

#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::cutting {

class RestElements;

/// How much of what a blade does to a place each sphere around it can bear. A crumb that hangs on few elements, or on
/// none, bears next to nothing: it would be flung away. And a blade reaches only what is near it, wherever that was at
/// rest: a piece that fell away is not pulled at from afar. All other spheres bear in full.
class Bearing {
 public:
  /// `model` must outlive the Bearing.
  Bearing(const Model& model, const RestElements& elements);

  /// Follows the severed elements of `state`.
  void update(const State& state);

  /// Whether an element of a sphere is severed.
  bool has_severed(std::int32_t sphere) const { return whole_[std::size_t(sphere)] < all_[std::size_t(sphere)]; }

  /// Share of a sphere by its elements: 1 where more than a third are whole, less from there on, but never 0.
  double share(std::int32_t sphere) const { return share_[std::size_t(sphere)]; }

 private:
  void count(std::int32_t sphere, int change);

  const Model& model_;
  std::vector<std::uint8_t> severed_;      ///< that are counted (axial_count)
  std::vector<std::int32_t> all_, whole_;  ///< elements of each sphere (sphere_count)
  std::vector<double> share_;              ///< (sphere_count)
};

/// Where a blade is that does something to a place in the tissue.
struct BladeAt {
  const Bearing& bearing;
  const Vec3Array& position;  ///< of the spheres [m]
  Vec3 point;                 ///< of the blade [m]

  /// Share of a sphere that is at `rest_distance` from the place at rest [m], in an organ of a spacing [m]: 1 within
  /// twice that and a spacing, 0 beyond three times that and two spacings.
  double share(std::int32_t sphere, double rest_distance, double spacing) const;
};

}  // namespace ctpm::cutting
