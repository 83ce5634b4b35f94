#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/contact/pin.h"
#include "core/elements/axial.h"
#include "core/model/model.h"

namespace ctpm::contact {

/// A force on a point that two spheres carry, x = weight_a x_a + weight_b x_b: a spring along an axis and drag across
/// it. The weights of a point on an element sum to 1. Those of a pair that keeps its distance are -1 and 1, so that the
/// forces are opposite.
struct PairContact {
  std::int32_t a = -1, b = -1;
  double weight_a = 0, weight_b = 0;
  Vec3 axis{};                       ///< unit vector
  Vec3 force{};                      ///< force on the point at rest [N]
  double k = 0;                      ///< decrease of the force along the axis per displacement along it [N/m], >= 0
  double drag = 0;                   ///< across the axis [N s/m], >= 0
  bool only_pushes = false;          ///< is dropped when it would pull the point against the axis
  bool is_tool = false;              ///< a tool bears the opposite force
  std::array<double, 18> without{};  ///< force and diagonal block of both spheres before linearise()
};

/// All pair contacts of a step. Detectors add contacts; only Contacts (contacts.h) calls the rest.
class PairContacts {
 public:
  /// Reserves `capacity` contacts, so that a tick never allocates.
  PairContacts(const Model& model, std::size_t capacity) : model_(model) { contacts_.reserve(capacity); }

  void add(const PairContact& contact) { contacts_.push_back(contact); }
  std::size_t count() const { return contacts_.size(); }

 private:
  friend class Contacts;
  friend class ContactSet;
  friend class LinearisedContacts;

  void clear() { contacts_.clear(); }

  /// Makes the solve start from `velocity` [m/s] instead of rest; call it before linearise().
  void start_from(const Vec3Array& velocity);

  /// Adds contact forces [N] and their linearisation for a step of `h` [s].
  void linearise(double h, elements::Coordinates& force, elements::DiagonalBlocks& blocks);

  /// Restores `force` and `blocks` to the bit as they were before the last linearise(). Later additions to the same
  /// arrays must be taken back first.
  void undo_linearise(elements::Coordinates& force, elements::DiagonalBlocks& blocks) const;

  /// Adds these contacts, found in the middle of an explicit step of `h` [s], to the `velocity` [m/s] that the step
  /// reached without them. Contacts follow one after the other, each solved implicitly. `before`: velocity [m/s] at the
  /// start. Spheres keep their velocity along held axes, and so does the sphere of `pin`. Returns the force on the tool
  /// [N].
  Vec3 push_apart(double h, const Pin& pin, const Vec3Array& before, Vec3Array& velocity);

  /// result += coupling of a step of `h` [s] times `v`, in the precision of `v`, float or double.
  /// Returns v . coupling . v.
  template <class Real>
  double apply(double h, const Real* v, Real* result) const;

  /// Whether a contact would pull after a step of `h` [s] with velocity `v` [m/s].
  bool has_pulling(double h, const elements::Coordinates& v) const;

  /// Removes the contacts that would pull.
  void drop_pulling(double h, const elements::Coordinates& v);

  /// Force on the tool [N] after an implicit step.
  Vec3 force_on_tool(double h, const elements::Coordinates& v) const;
  /// Number of contacts with the tool.
  std::int32_t tool_count() const;

  template <class Real>
  Vec3 velocity_of(const PairContact& contact, const Real* v) const;
  Vec3 coupling(const PairContact& contact, double h, Vec3 u) const;
  bool pulls(const PairContact& contact, double h, const elements::Coordinates& v) const;

  const Model& model_;
  std::vector<PairContact> contacts_;
};

}  // namespace ctpm::contact
