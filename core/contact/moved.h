#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::contact {

/// More than what rounding adds to bounds that moves are summed up to [m]: what they leave out is outside, not just
/// about to be.
inline constexpr double kRounding = 1e-6;

/// A sum of moves begins anew from here on: beside a longer one, as after an explosion, the moves of a tick would be
/// lost in rounding [m].
inline constexpr double kLongestPath = 1e3;

/// How far the farthest of points number [begin, end) of `before` has moved, seen from something that moved `by`: to
/// where they are in `now`, with numbers that are greater by `first` [m]. Infinitely far if any place is not finite, as
/// in a step that is refused.
inline double farthest_moved(const Vec3Array& before, std::size_t begin, std::size_t end, const Vec3Array& now,
                             std::size_t first, Vec3 by) {
  double squared = 0;
  bool is_finite = true;
  for (std::size_t i = begin; i < end; ++i) {
    const double x = now.x[first + i] - before.x[i] - by.x, y = now.y[first + i] - before.y[i] - by.y,
                 z = now.z[first + i] - before.z[i] - by.z, apart = x * x + y * y + z * z;
    squared = std::max(apart, squared), is_finite &= apart <= std::numeric_limits<double>::max();
  }
  return is_finite ? std::sqrt(squared) : std::numeric_limits<double>::infinity();
}

/// Spheres of which now and then it is asked how far they have come.
class WatchedSpheres {
 public:
  /// Reserves memory for `count` of them.
  void reserve(std::size_t count) { sphere_.reserve(count), seen_.reserve(count); }
  void add(std::int32_t sphere) { sphere_.push_back(sphere), seen_.emplace_back(); }

  /// `length(by)` of the farthest of their moves since the last call; `position`: of all spheres [m].
  template <class Length>
  double farthest_moved(const Vec3Array& position, Length&& length) {
    double farthest = 0;
    for (std::size_t i = 0; i < sphere_.size(); ++i) {
      const Vec3 now = position[std::size_t(sphere_[i])];
      farthest = std::max(farthest, length(now - std::exchange(seen_[i], now)));
    }
    return farthest;
  }

 private:
  std::vector<std::int32_t> sphere_;
  std::vector<Vec3> seen_;  ///< where they were in the last call [m]
};

}  // namespace ctpm::contact
