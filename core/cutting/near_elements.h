#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cutting/blade_geometry.h"
#include "core/model/model.h"

namespace ctpm::cutting {

/// The axial elements near a blade, so that a tick checks only these. The others cannot meet the blade.
class NearElements {
 public:
  /// Holds all elements until find().
  explicit NearElements(const Model& model);

  /// Keeps the elements that a blade within `box` can meet while no sphere moves farther than kMargin from `position`.
  void find(const Vec3Array& position, const Box& box);

  /// Takes all elements if a sphere has moved farther than kMargin since find().
  void follow(const Vec3Array& position);

  /// Rows of Model::axial, ascending.
  std::span<const std::int32_t> elements() const { return {near_.data(), count_}; }

 private:
  static constexpr double kMargin = 2e-3;  ///< [m]; a sphere at 2 m/s moves this far in a tick of 1 ms

  void take_all();

  const Model& model_;
  Vec3Array found_at_;                 ///< (sphere_count)
  std::vector<std::uint8_t> outside_;  ///< bit set: the sides of the box that a sphere is outside of (sphere_count)
  std::vector<std::int32_t> near_;     ///< capacity for all elements; the first count_ are near
  std::size_t count_ = 0;
};

}  // namespace ctpm::cutting
