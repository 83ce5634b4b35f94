#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/elements/axial.h"
#include "core/elements/kernels/kernels.h"
#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm {

/// Damping along the normal [N s/m] of a contact of stiffness `k` [N/m] with a sphere of `mass` [kg] at `penetration`
/// [m]. `hunt_crossley` [s/m] is c in the law k p (1 + c p') of Hunt & Crossley, "Coefficient of restitution
/// interpreted as damping in vibroimpact" (1975). The result never exceeds critical damping.
double contact_damping(double hunt_crossley, double k, double mass, double penetration);

/// Drag across the normal [N s/m] of a tool's contact at `penetration` [m] that slips at `speed` [m/s]: viscous while
/// the surfaces stick, limited by Coulomb's law when they slip.
double contact_drag(const Model& model, double penetration, double speed);

/// Shares of the velocities after and before an explicit step in what acts in its middle. A quarter of each in a
/// penetration (Newmark's average acceleration) and a half in damping are of second order; of what the step is too long
/// to follow the velocity after it has more, so that it does not ring.
struct ContactShares {
  /// `k`, `c`: stiffness and damping against the mass, h^2 k / m and h c / m [1].
  ContactShares(double k, double c);

  double after = 0.25, before = 0.25, damped_after = 0.5, damped_before = 0.5;
};

/// One sphere that a tool presses: a penalty spring with damping along the line between the centres, and drag across it
/// that is viscous while the surfaces stick and limited by Coulomb's law when they slip; both solved
/// implicitly.
struct Contact {
  std::int32_t sphere;
  Vec3 normal;         ///< unit vector from the tool to the sphere
  double penetration;  ///< of the sphere, as it was given, into the tool [m], > 0
  double damping;      ///< along the normal [N s/m], >= 0
  double drag;         ///< across the normal [N s/m], >= 0
  double approach;     ///< with which a solve starts [m/s]: within what leads to the penetration or out of reach in a
                       ///< step, however far the hand jumps
  Vec3 slip;           ///< across the normal, of the velocity that a solve starts from, against the tool's [m/s]
  Vec3 acting{};       ///< force on the sphere in an explicit step [N]
  std::array<double, 9> without{};  ///< force and block of its sphere before the contact was added
};

/// Contacts of a rigid ball with spheres.
class BallContact {
 public:
  BallContact(const Model& model, const Kernels& kernels);

  /// Finds the spheres that a ball of `radius` [m] at `centre`, moving with `velocity` [m/s], overlaps in a step of `h`
  /// [s]. A solve starts from State::velocity if `from_velocity`, else from spheres that rest; velocities `v` below are
  /// changes from there.
  void find(const State& state, Vec3 centre, double radius, Vec3 velocity, double h, bool from_velocity);

  /// Adds contact forces [N] and linearisation for a step of `h` [s].
  void linearise(double h, Coordinates& force, DiagonalBlocks& blocks);

  /// Takes back to the bit what the last linearise() added.
  void undo_linearise(Coordinates& force, DiagonalBlocks& blocks) const;

  /// After an explicit step of `h` [s] without contacts, found in its middle: changes the `velocity` [m/s] of the
  /// touched spheres, each contact solved implicitly by itself, and drops contacts that would pull. `before`: velocity
  /// [m/s] at the start. Spheres do not move along `held_axes`.
  void push_apart(double h, std::span<const std::uint8_t> held_axes, const Vec3Array& before, Coordinates& velocity);

  /// result += coupling of a step of `h` [s] times `v`, in the precision of `v`, float or double;
  /// returns v . coupling . v.
  template <class Real>
  double apply(double h, const Real* v, Real* result) const;

  /// Whether a contact would pull its sphere after a step of `h` [s] with velocity `v` [m/s].
  bool has_pulling(double h, const Coordinates& v) const;

  /// Removes the contacts that would.
  void drop_pulling(double h, const Coordinates& v);

  /// Force on the tool [N] after the step.
  Vec3 force_on_tool(double h, const Coordinates& v) const;

  /// Largest displacement from rest of a touched sphere along its contact [m], 0 without contact.
  double depth(const State& state) const;

  std::int32_t count() const { return std::int32_t(contacts_.size()); }
  void clear() { contacts_.clear(), is_explicit_ = false; }

 private:
  void find_among(const State& state, Vec3 centre, double radius, double h, bool from_velocity, std::size_t begin,
                  std::size_t end);
  Vec3 change_of(const Contact& contact, const Coordinates& v) const;
  double coupling_along(const Contact& contact, double h) const;
  double pressure(const Contact& contact, double h, const Coordinates& v) const;

  const Model& model_;
  const Kernels& kernels_;
  double largest_radius_ = 0;      ///< of a sphere [m]
  Vec3 velocity_;                  ///< of the tool [m/s]
  bool is_explicit_ = false;       ///< push_apart() has solved them
  std::vector<Contact> contacts_;  ///< room for every sphere if the scene has a ball, so that a tick never allocates
};

}  // namespace ctpm
