#pragma once

#include <cmath>

#include "core/model/state.h"
#include "tests/core/cut_blocks.h"

namespace ctpm::testing {

inline constexpr double kTop = 0.036;  ///< of a block of four layers [m]

/// Where spheres are in a tick that swing about their places at rest, those on top the most [m].
inline void swing(const Vec3Array& rest, int tick, Vec3Array& position) {
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3 p = rest[i];
    const double by = 2e-3 * std::sin(0.05 * tick + 60 * p.x) * p.z / kTop;
    position.set(i, p + Vec3{by, 0.5 * by, -std::abs(by)});
  }
}

/// A block of four layers with an upright cut across it, down to `bottom` [m].
inline State half_cut(const Model& model, double bottom) {
  State state = rest_state(model);
  cut_along(
      model,
      [&](double t) {
        const double y = -0.06 + 0.12 * t;
        return straight_front({0, y, bottom}, {0, y, 0.06});
      },
      state);
  return state;
}

}  // namespace ctpm::testing
