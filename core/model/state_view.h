#pragma once

#include <cstdint>
#include <vector>

#include "core/model/state.h"

namespace ctpm {

/// What elements and contacts read of a State at one moment of a step. It refers to the arrays of a State, or to others
/// in their place: a step evaluates forces at moments that State does not reach.
struct StateView {
  const Vec3Array& position;                       ///< [m]    (sphere_count)
  const Vec3Array& velocity;                       ///< [m/s]  (sphere_count)
  const std::vector<double>& kelvin_elongation;    ///< [m]    (internal_count)
  const std::vector<std::uint8_t>& axial_severed;  ///< as State's, the others too
  const std::vector<std::uint8_t>& constraint_severed;
  const std::vector<std::uint8_t>& angle_severed;

  StateView(const State& s) : StateView(s, s.position, s.velocity, s.kelvin_elongation) {}  // implicit on purpose

  /// `state`, which must outlive the view, with other positions, velocities and Kelvin elongations.
  template <class Base>
  StateView(const Base& state, const Vec3Array& position_, const Vec3Array& velocity_,
            const std::vector<double>& kelvin_elongation_)
      : position(position_),
        velocity(velocity_),
        kelvin_elongation(kelvin_elongation_),
        axial_severed(state.axial_severed),
        constraint_severed(state.constraint_severed),
        angle_severed(state.angle_severed) {}
};

}  // namespace ctpm
