#pragma once

#include <cstdint>
#include <vector>

#include "core/axial.h"
#include "core/contact.h"
#include "core/model.h"
#include "core/pair_contact.h"

namespace ctpm {

/// What acts on the spheres from outside the tissue in one substep, whatever the integrator.
struct Outside {
  double h = 0;          ///< length of the substep [s]
  double end_time = 0;   ///< simulated time at its end [s]
  bool has_loads = true; ///< loads act (they do not while a scene settles)
  BallContact& contact;
  PairContacts& pairs;   ///< a blade's, and those of the lips of cuts
  std::vector<std::uint8_t>& held_axes;  ///< of the Model, and of the sphere that a pin holds (sphere_count)
  std::int32_t pinned = -1;              ///< sphere that a pin holds; -1: none
  Vec3 pin_velocity;                     ///< that brings the pinned sphere to the hand [m/s]

  bool is_held(std::size_t sphere, std::size_t axis) const { return (held_axes[sphere] >> axis & 1) != 0; }
};

/// Writes the weight of spheres [begin, end) into `force` [N]  (3 x sphere_count).
void set_weight(const Model& model, std::size_t begin, std::size_t end, Coordinates& force);

/// Adds loads, while they act, to `force` [N].
void add_loads(const Model& model, const Outside& outside, Coordinates& force);

/// momentum = mass * velocity + h * force [kg m/s] of spheres [begin, end)  (3 x sphere_count).
void find_momentum(const Model& model, const State& state, double h, const Coordinates& force, std::size_t begin,
                   std::size_t end, Coordinates& momentum);

/// Velocities of spheres [begin, end) from which a solve starts: those of `state`, none along held axes, the hand's
/// where a pin holds.
void start_velocities(const State& state, const Outside& outside, std::size_t begin, std::size_t end,
                      Coordinates& velocity);

}  // namespace ctpm
