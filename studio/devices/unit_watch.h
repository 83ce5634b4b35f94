#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "core/model/vec3.h"

namespace ctpm::devices {

/// Suspects a device that sends metres where millimetres are meant: its hand moves for seconds and stays within a
/// sphere around the device's origin that a hand leaves at its first movement.
class UnitWatch {
 public:
  /// Takes a good pose: its place in the scene's lengths, from the device's origin [m], and when it came [s].
  void add(Vec3 position, double now) {
    if (is_done_) return;
    if (!first_) first_ = position, since_ = now;
    moved_ = std::max(moved_, norm(position - *first_));
    const bool is_near = norm(position) <= kNear;
    suspects_ = is_near && now - since_ >= kLongEnough && moved_ >= kMoved;
    is_done_ = suspects_ || !is_near;
  }

  /// True once, when it is suspected.
  bool take_suspicion() { return std::exchange(suspects_, false); }

  static constexpr double kNear = 2e-3;     ///< [m]; two metres of a hand, a thousandth of them
  static constexpr double kMoved = 5e-5;    ///< what no device trembles that knows its place so near its origin [m]
  static constexpr double kLongEnough = 3;  ///< [s]

 private:
  std::optional<Vec3> first_;
  double since_ = 0, moved_ = 0;
  bool is_done_ = false, suspects_ = false;
};

}  // namespace ctpm::devices
