#pragma once

#include <algorithm>
#include <cmath>

#include "core/model/vec3.h"

namespace ctpm::contact {

/// How far the farthest of some points has moved: from `before` to where they are in `now`, from number `first` on [m].
inline double farthest_moved(const Vec3Array& before, const Vec3Array& now, std::size_t first = 0) {
  double squared = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double x = now.x[first + i] - before.x[i], y = now.y[first + i] - before.y[i],
                 z = now.z[first + i] - before.z[i];
    squared = std::max(x * x + y * y + z * z, squared);
  }
  return std::sqrt(squared);
}

}  // namespace ctpm::contact
