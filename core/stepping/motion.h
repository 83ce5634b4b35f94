#pragma once

#include <vector>

#include "core/contact/contacts.h"
#include "core/elements/axial.h"
#include "core/model/model.h"
#include "core/model/state.h"
#include "core/parallel/slabs.h"
#include "core/parallel/team.h"

namespace ctpm::stepping {

/// The part of a State that an integrator advances.
struct Motion {
  /// Room for the spheres and two-sphere TPMs of `model`, without accelerations.
  explicit Motion(const Model& model)
      : position(model.sphere_count()),
        velocity(model.sphere_count()),
        kelvin_elongation(model.axial.internal_count()) {}

  Vec3Array position, velocity;           ///< [m], [m/s]  (sphere_count)
  Vec3Array acceleration;                 ///< [m/s^2]; empty unless the integrator is SDIRK2 (sphere_count)
  std::vector<double> kelvin_elongation;  ///< [m] (internal_count)
  contact::Touched touched;               ///< State::touched and what belongs to it
  std::vector<std::int32_t> still_ticks;  ///< as in State
};

/// Of all spheres [kg].
double total_mass(const Model& model);

/// Puts `motion` into `state`, where what sleeps stays as it is and without motion. Swaps arrays if nothing sleeps, and
/// otherwise copies the spheres that are awake.
void commit(const parallel::Slabs& slabs, parallel::Team& team, Motion& motion, State& state);

/// to = position + h * velocity  (sphere_count); `to` must be another array than `position`.
void drift(const parallel::Slabs& slabs, parallel::Team& team, const Vec3Array& position, const Vec3Array& velocity,
           double h, Vec3Array& to);

/// position += h * velocity  (sphere_count).
void drift(const parallel::Slabs& slabs, parallel::Team& team, const Vec3Array& velocity, double h,
           Vec3Array& position);

/// Sets the velocities of `to` to the solution `velocity` (3 x sphere_count), and its positions to those after a step
/// of `h` [s] from `position`.
void commit_velocity(const parallel::Slabs& slabs, parallel::Team& team, const elements::Coordinates& velocity,
                     const Vec3Array& position, double h, Motion& to);

}  // namespace ctpm::stepping
