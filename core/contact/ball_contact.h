#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/pin.h"
#include "core/elements/axial.h"
#include "core/elements/kernels/kernels.h"
#include "core/model/model.h"
#include "core/model/state_view.h"

namespace ctpm::contact {

/// Contact of a ball with one sphere: a penalty spring with damping along the line between the centres
/// (contact_damping), and drag across it (contact_drag). Both are solved implicitly.
struct SphereContact {
  std::int32_t sphere;
  Vec3 normal;         ///< unit vector from the ball to the sphere
  double penetration;  ///< depth of the sphere in the ball at detection [m], > 0
  double damping;      ///< along the normal [N s/m], >= 0
  double drag;         ///< across the normal [N s/m], >= 0
  /// Speed of approach along the normal at the start of the solve [m/s]. It is clamped to what leads to the
  /// penetration, or out of contact, in one step, however far the hand jumps.
  double approach;
  Vec3 slip;  ///< velocity across the normal at the start of the solve, relative to the ball [m/s]
  std::array<double, 9> without{};  ///< force and diagonal block of its sphere before linearise()
};

/// Contacts of a rigid ball with spheres. Only Contacts (contacts.h) calls it.
class BallContact {
 public:
  BallContact(const Model& model, const elements::Kernels& kernels);

 private:
  friend class Contacts;
  friend class ContactSet;
  friend class LinearisedContacts;

  /// Finds the spheres that overlap, in a step of `h` [s], a ball of `radius` [m] at `centre` that moves with
  /// `velocity` [m/s]. The solve starts from StateView::velocity if `from_velocity`, else from rest. Velocities `v`
  /// below are changes from that start.
  void find(const StateView& state, Vec3 centre, double radius, Vec3 velocity, double h, bool from_velocity);

  /// Adds contact forces [N] and their linearisation for a step of `h` [s].
  void linearise(double h, elements::Coordinates& force, elements::DiagonalBlocks& blocks);

  /// Restores `force` and `blocks` to the bit as they were before the last linearise().
  void undo_linearise(elements::Coordinates& force, elements::DiagonalBlocks& blocks) const;

  /// Adds the contacts, found in the middle of an explicit step of `h` [s], to the `velocity` [m/s] that the step
  /// reached without them. Each contact is solved implicitly by itself; those that would pull are dropped. `before`:
  /// velocity [m/s] at the start. Spheres keep their velocity along held axes, and so does the sphere of `pin`. Returns
  /// the force on the ball [N].
  Vec3 push_apart(double h, const Pin& pin, const Vec3Array& before, Vec3Array& velocity);

  /// result += coupling of a step of `h` [s] times `v`, in the precision of `v`, float or double.
  /// Returns v . coupling . v.
  template <class Real>
  double apply(double h, const Real* v, Real* result) const;

  /// Whether a contact would pull its sphere after a step of `h` [s] with velocity `v` [m/s].
  bool has_pulling(double h, const elements::Coordinates& v) const;

  /// Removes the contacts that would pull.
  void drop_pulling(double h, const elements::Coordinates& v);

  /// Force on the ball [N] after an implicit step.
  Vec3 force_on_tool(double h, const elements::Coordinates& v) const;

  /// Largest displacement from rest at `position` of a touched sphere along its contact [m], 0 without contact.
  double depth(const Vec3Array& position) const;

  std::int32_t count() const { return std::int32_t(contacts_.size()); }
  void clear() { contacts_.clear(); }

  void find_among(const StateView& state, Vec3 centre, double radius, double h, bool from_velocity, std::size_t begin,
                  std::size_t end);
  Vec3 change_of(const SphereContact& contact, const elements::Coordinates& v) const;
  double coupling_along(const SphereContact& contact, double h) const;
  double pressure(const SphereContact& contact, double h, const elements::Coordinates& v) const;

  const Model& model_;
  const elements::Kernels& kernels_;
  double largest_radius_ = 0;  ///< of a sphere [m]
  Vec3 velocity_;              ///< of the ball [m/s]
  /// Capacity for every sphere if the scene has a ball, so that a tick never allocates.
  std::vector<SphereContact> contacts_;
};

}  // namespace ctpm::contact
