#pragma once

#include <cstdint>
#include <vector>

#include "core/contact/contact.h"
#include "core/contact/pair_contact.h"
#include "core/elements/axial.h"
#include "core/model/model.h"
#include "core/parallel/slabs.h"

namespace ctpm {

/// What acts on the spheres from outside the tissue in one substep, whatever the integrator.
struct Outside {
  double h = 0;           ///< length of the substep [s]
  double time = 0;        ///< simulated time at which forces are wanted [s]
  bool has_loads = true;  ///< loads act (they do not while a scene settles)
  BallContact& contact;
  PairContacts& pairs;                   ///< a blade's, and those of the lips of cuts
  std::vector<std::uint8_t>& held_axes;  ///< of the Model, and of the sphere that a pin holds (sphere_count)
  std::int32_t pinned = -1;              ///< sphere that a pin holds; -1: none
  Vec3 pin_velocity{};                   ///< that brings the pinned sphere to the hand [m/s]
  Vec3 velocity_before_pin{};            ///< of the pinned sphere, before the substep [m/s]
};

/// Spheres of which an axis or more is held.
class HeldSpheres {
 public:
  HeldSpheres(const Model& model, const Slabs& slabs);

  /// Sets velocities along held axes of a slab's spheres to 0, and that of the pinned sphere to the hand's.
  void stop(const Outside& outside, int slab, Coordinates& velocity) const;

 private:
  const Model& model_;
  const Slabs& slabs_;
  std::vector<std::vector<std::int32_t>> of_slab_;
};

/// Writes the weight of spheres [begin, end) into `force` [N]  (3 x sphere_count).
void set_weight(const Model& model, std::size_t begin, std::size_t end, Coordinates& force);

/// Adds loads, while they act, of spheres [begin, end) to `force` [N].
void add_loads(const Model& model, const Outside& outside, std::size_t begin, std::size_t end, Coordinates& force);

/// momentum = mass * (velocity - guess) + h * force [kg m/s] of spheres [begin, end)  (3 x sphere_count); a null guess
/// is none.
void find_momentum(const Model& model, const Vec3Array& velocity, const Vec3Array* guess, double h,
                   const Coordinates& force, std::size_t begin, std::size_t end, Coordinates& momentum);

}  // namespace ctpm
