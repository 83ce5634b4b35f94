#pragma once

#include "core/model/vec3.h"

namespace ctpm {

/// An axis-parallel box around points.
struct Box {
  Vec3 low, high;

  explicit Box(Vec3 p) : low(p), high(p) {}
  template <class... Points>
  explicit Box(Vec3 first, Points... others) : low(first), high(first) {
    (add(others), ...);
  }
  void add(Vec3 p) {
    low = {p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y, p.z < low.z ? p.z : low.z};
    high = {p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y, p.z > high.z ? p.z : high.z};
  }
  /// The box that contains this one moved by each displacement in `by`.
  Box moved(const Box& by) const { return Box(low + by.low, high + by.high); }
  Box grown(double by) const { return Box(low - Vec3{by, by, by}, high + Vec3{by, by, by}); }
  bool meets(const Box& other) const {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y &&
           low.z <= other.high.z && other.low.z <= high.z;
  }
};

/// Distance between two boxes [m]; 0 if they meet.
inline double gap(const Box& a, const Box& b) {
  const auto along = [](double low, double high, double other_low, double other_high) {
    return low > other_high ? low - other_high : other_low > high ? other_low - high : 0.0;
  };
  return norm({along(a.low.x, a.high.x, b.low.x, b.high.x), along(a.low.y, a.high.y, b.low.y, b.high.y),
               along(a.low.z, a.high.z, b.low.z, b.high.z)});
}

}  // namespace ctpm
