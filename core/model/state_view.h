#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/model/state.h"

namespace ctpm {

/// The part of a State that elements and contacts read. It refers to the arrays of a State or to substitutes, since a
/// step evaluates forces at intermediate positions that State never takes.
struct StateView {
  const Vec3Array& position;                       ///< [m]    (sphere_count)
  const Vec3Array& velocity;                       ///< [m/s]  (sphere_count)
  const std::vector<double>& kelvin_elongation;    ///< [m]    (internal_count)
  const std::vector<std::uint8_t>& axial_severed;  ///< as in State, like the next five
  const std::vector<std::uint8_t>& constraint_severed;
  const std::vector<std::uint8_t>& angle_severed;
  const std::vector<std::int32_t>& touched;
  const Vec3Array& grip;
  const std::vector<double>& kelvin_dent;

  /// Index of a point in `touched`; -1 if it was not touched at the start of the step.
  std::ptrdiff_t find_touched(std::int32_t point) const {
    const auto found = std::lower_bound(touched.begin(), touched.end(), point);
    return found == touched.end() || *found != point ? -1 : found - touched.begin();
  }

  StateView(const State& s) : StateView(s, s.position, s.velocity, s.kelvin_elongation) {}  // implicit on purpose

  /// A view of `state`, which must outlive it, with other positions, velocities and Kelvin elongations.
  template <class Base>
  StateView(const Base& state, const Vec3Array& position_, const Vec3Array& velocity_,
            const std::vector<double>& kelvin_elongation_)
      : position(position_),
        velocity(velocity_),
        kelvin_elongation(kelvin_elongation_),
        axial_severed(state.axial_severed),
        constraint_severed(state.constraint_severed),
        angle_severed(state.angle_severed),
        touched(state.touched),
        grip(state.grip),
        kelvin_dent(state.kelvin_dent) {}
};

}  // namespace ctpm
