#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/contact_law.h"
#include "core/contact/pin.h"
#include "core/elements/axial.h"
#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::contact {

/// A force on a point that spheres carry, x = sum of weight times sphere position: along an axis a spring with damping,
/// across it drag. The weights of a point of the tissue sum to 1. Those of a pair that keeps its distance are -1 and 1,
/// so that the forces are opposite.
struct PointContact {
  Vec3 axis{};               ///< unit vector
  Vec3 force{};              ///< on the point at the start of the solve [N]
  double k = 0;              ///< decrease of the force along the axis per displacement along it [N/m], >= 0
  double damping = 0;        ///< the same per velocity along it [N s/m], >= 0
  double drag = 0;           ///< decrease of the force across the axis per velocity across it [N s/m], >= 0
  bool only_pushes = false;  ///< is dropped when it would pull the point against the axis
  // Of a point that something draws along the axis with a steady force, as a blade draws the front of its cut. A force
  // that would draw it past what draws it becomes a spring between the two.
  Vec3 apart{};            ///< from the point to what draws it, at the start of the solve [m]
  double near_k = 0;       ///< stiffness of the spring [N/m]; 0: the force stays as it is
  std::int32_t hand = -1;  ///< whose tool bears the opposite force; -1: no tool does
  // Of a point that something presses: a ball, an obstacle or other tissue. It also grips the point. Places and
  // velocities are relative to what presses: for a ball to its centre, for an obstacle to the world.
  std::int32_t point = -1;  ///< number of the point in State::touched; -1: not a pressed point
  Vec3 start{};             ///< velocity of the point at the start of the solve [m/s]
  double grip_k = 0;        ///< stiffness of the grip across the axis [N/m]
  double grip_c = 0;        ///< damping of the grip [N s/m]
  double most_grip = 0;     ///< friction cone: coefficient times pressure [N]
  Vec3 anchor{};            ///< where the point is held [m]
  Vec3 gripped{};           ///< elongation of the grip at the start of the solve, across the axis [m]
  Vec3 found{};             ///< place of the point at detection [m]
  double dent = 0;          ///< depth of the dent at detection [m]
  double kelvin_dent = 0;   ///< the Kelvin unit's part of it at the start of the substep [m]
  Foundation foundation{};  ///< of the dent, over the substep
  Vec3 slip_guess{};        ///< expected change of the velocity across the axis from the start of the solve [m/s]

  std::int32_t first = 0, count = 0;  ///< its entries in PointContacts; set by add()

  bool is_of_hand(std::size_t number) const { return hand == std::int32_t(number); }

  /// Whether a point with velocity `u` [m/s] passes what draws it within `h` [s].
  bool overtakes(double h, Vec3 u) const { return near_k > 0 && dot(axis, apart) < h * dot(axis, u); }
  /// Makes a spring of the force, for a solve of `h` [s].
  void hold_near(double h) { force = near_k * apart, k = near_k, drag = h * near_k, near_k = 0; }
};

/// Where a contact's force acts.
struct Carriers {
  std::span<const std::int32_t> sphere;
  std::span<const double> weight;
};

/// Sum of weight times value over the spheres.
Vec3 weighted(Carriers at, const Vec3Array& values);

/// Share of a grip's stiffness and damping that acts at an elongation [m] and slip [m/s]: less than 1 where its force
/// would leave the friction cone, so that it has the size of the cone.
double share_of_grip(const PointContact& contact, Vec3 elongation, Vec3 slip);

/// All point contacts of a step. Detectors add contacts; only Contacts (contacts.h) and ExplicitSolve call the rest.
class PointContacts {
 public:
  /// Reserves memory for `contacts` contacts with `entries` spheres in all, so that a tick never allocates.
  PointContacts(const Model& model, std::size_t contacts, std::size_t entries);

  void add(PointContact contact, Carriers carriers);
  /// A contact that two spheres carry.
  void add(const PointContact& contact, std::int32_t a, std::int32_t b, double weight_a, double weight_b);

  std::size_t count() const { return contacts_.size(); }
  std::size_t capacity() const { return contacts_.capacity(); }
  const std::vector<PointContact>& all() const { return contacts_; }
  Carriers carriers(const PointContact& contact) const {
    const auto first = std::size_t(contact.first), count = std::size_t(contact.count);
    return {std::span(sphere_).subspan(first, count), std::span(weight_).subspan(first, count)};
  }

  /// Inverse of the mass that a force on the point moves [1/kg]; 0 if all spheres are anchored.
  double mobility(Carriers carriers) const;

  /// Number of contacts with the tool in a hand.
  std::int32_t tool_count(std::size_t hand) const;

  template <class IsLeftOut>
  void leave_out(IsLeftOut&& is_left_out) {
    std::erase_if(contacts_, is_left_out);
  }
  void clear() { contacts_.clear(), sphere_.clear(), weight_.clear(); }

  /// Prepares an implicit step of `h` [s]: adds to the forces at the start of the solve what damping and grips give
  /// there. `velocity`: of the spheres at the start of the solve [m/s]; null: they are at rest.
  void begin_implicit(double h, const Vec3Array* velocity);

  /// Adds contact forces [N] and the diagonal of their linearisation for a step of `h` [s].
  void linearise(double h, elements::Coordinates& force, elements::DiagonalBlocks& blocks);

  /// Restores `force` and `blocks` to the bit as they were before the last linearise(). Later additions to the same
  /// arrays must be taken back first.
  void undo_linearise(elements::Coordinates& force, elements::DiagonalBlocks& blocks);

  /// result += coupling of a step of `h` [s] times `v`.
  void apply(double h, const double* v, double* result) const { apply_of<false>(h, v, result); }

  /// As above without the diagonal that linearise() added to the blocks, in the precision of `v`, float or double.
  template <class Real>
  void apply_lagged(double h, const Real* v, Real* result) const {
    apply_of<true>(h, v, result);
  }

  /// Whether a contact would pull, or draw its point too far, in a step of `h` [s] with velocity `v` [m/s].
  bool has_wrong(double h, const elements::Coordinates& v) const;

  /// Removes the contacts that would pull, and makes springs of those that would draw their point too far.
  void mend_wrong(double h, const elements::Coordinates& v);

  /// Force on the tool in a hand [N] after an implicit step.
  Vec3 force_on_tool(std::size_t hand, double h, const elements::Coordinates& v) const;

 private:
  friend class ExplicitSolve;

  template <class Real>
  Vec3 velocity_of(const PointContact& contact, const Real* v) const;
  Vec3 coupling(const PointContact& contact, double h, Vec3 u) const;
  template <bool kLagged, class Real>
  void apply_of(double h, const Real* v, Real* result) const;
  bool pulls(const PointContact& contact, double h, const elements::Coordinates& v) const;
  bool overtakes(const PointContact& contact, double h, const elements::Coordinates& v) const;

  /// Force and diagonal block of a sphere before linearise().
  struct Untouched {
    std::int32_t sphere;
    double force[3], block[6];
  };

  const Model& model_;
  std::vector<PointContact> contacts_;
  std::vector<std::int32_t> sphere_;  ///< of all contacts' entries
  std::vector<double> weight_;
  std::vector<Untouched> untouched_;
  std::vector<std::uint8_t> is_touched_;  ///< (sphere_count, or empty without contacts)
};

}  // namespace ctpm::contact
