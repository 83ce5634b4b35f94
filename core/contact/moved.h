#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/model/vec3.h"

namespace ctpm::contact {

/// More than what rounding adds to bounds that moves are summed up to [m]: what they leave out is outside, not just
/// about to be.
inline constexpr double kRounding = 1e-6;

/// How far the farthest of some points has moved: from `before` to where they are in `now`, from number `first` on [m].
/// Infinitely far if any place is not finite, as in a step that is refused.
inline double farthest_moved(const Vec3Array& before, const Vec3Array& now, std::size_t first = 0) {
  double squared = 0;
  bool is_finite = true;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double x = now.x[first + i] - before.x[i], y = now.y[first + i] - before.y[i],
                 z = now.z[first + i] - before.z[i], apart = x * x + y * y + z * z;
    squared = std::max(apart, squared), is_finite &= apart <= std::numeric_limits<double>::max();
  }
  return is_finite ? std::sqrt(squared) : std::numeric_limits<double>::infinity();
}

}  // namespace ctpm::contact
