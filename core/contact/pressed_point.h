#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/contact/point_contact.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/surface/near_surface.h"

namespace ctpm::contact {

/// The step in which points are pressed.
struct PressStep {
  double h;            ///< length [s]
  double elapsed;      ///< from the start of the substep to the end of this step [s]
  double ahead;        ///< from the start of the substep to the positions at detection [s]
  bool from_velocity;  ///< whether the solve starts from StateView::velocity; else from rest
};

/// How a pressed point moves, relative to what presses it.
struct Approach {
  Vec3 place;                                                ///< at detection [m]
  Vec3 start;                                                ///< velocity at the start of the solve [m/s]
  Vec3 slip_guess;                                           ///< expected change of it [m/s]
  double nearer = std::numeric_limits<double>::infinity();   ///< it comes no nearer in one step than this [m]
  double farther = std::numeric_limits<double>::infinity();  ///< it goes no farther in one step than this [m]
};

/// Completes the contact of a pressed point, of which axis, point, dent, foundation and damping are set: its force, and
/// its grip. A spring holds the point at a place on what presses it, up to the friction cone; beyond it the place
/// slides (Cundall & Strack, "A discrete numerical model for granular assemblies", Geotechnique 29, 1979). A contact at
/// rest therefore stays where it is. `mobility` [1/kg]: of the point, > 0.
void press(const StateView& state, double friction, double mobility, const Approach& approach, const PressStep& step,
           PointContact& contact);

/// Adds up the spheres that carry a point which is a weighted sum of others.
class CarrierSum {
 public:
  /// Of `spheres` spheres at most, so that add() never allocates.
  explicit CarrierSum(std::size_t spheres) : place_(spheres, -1) { sphere_.reserve(spheres), weight_.reserve(spheres); }

  void clear();
  void add(const surface::Follower& point, double weight) { add(Carriers{point.sphere, point.weight}, weight); }
  void add(Carriers point, double weight);
  /// Changes the weights as little as a linear function of the place does, so that their sum stays and the point moves
  /// by `by` [m] with the spheres at `position` [m]. Where the spheres do not span space, it stays.
  void move(const Vec3Array& position, Vec3 by);
  Carriers get() const { return {sphere_, weight_}; }  ///< until the next add() or clear()

 private:
  std::vector<std::int32_t> place_;  ///< of a sphere in sphere_; -1: not there (sphere_count)
  std::vector<std::int32_t> sphere_;
  std::vector<double> weight_;
};

}  // namespace ctpm::contact
