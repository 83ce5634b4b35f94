#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/contact/ball_contact.h"
#include "core/contact/blade_force.h"
#include "core/contact/blade_wedge.h"
#include "core/contact/body_contact.h"
#include "core/contact/cut_face_contact.h"
#include "core/contact/cut_surfaces.h"
#include "core/contact/explicit_solve.h"
#include "core/contact/held_tool.h"
#include "core/contact/obstacle_contact.h"
#include "core/contact/own_motion.h"
#include "core/contact/pin.h"
#include "core/contact/point_contact.h"
#include "core/elements/axial.h"
#include "core/elements/kernels/kernels.h"
#include "core/model/model.h"
#include "core/model/stage.h"
#include "core/model/state_view.h"

namespace ctpm::contact {

class Contacts;
class ExplicitContacts;
class ImplicitContacts;

/// The step for which contacts are detected.
struct ContactStep {
  double h;        ///< length [s]
  double elapsed;  ///< from the start of the substep to the end of this step [s]
  double ahead;    ///< from the start of the substep to the positions at detection [s]
  double share;    ///< part of the tick's tool motion that is done at detection, 0 to 1
  Pins pins;       ///< of this step
};

/// What State remembers of what is touched: State::touched, grip and kelvin_dent.
struct Touched {
  std::vector<std::int32_t> point;
  Vec3Array grip;                   ///< [m]
  std::vector<double> kelvin_dent;  ///< [m]
};

/// The motion about which an implicit step is linearised. Its velocities are changes from that motion.
enum class Linearisation {
  rest,      ///< spheres at rest
  velocity,  ///< spheres that move with StateView::velocity
};

/// All contacts of a Model: of balls, a blade and pins, between tissue and obstacles, and between tissue. Its
/// capacity is fixed at construction, so that a tick never allocates. Detection returns a set; the type of the set says
/// what a step may do with its contacts. A Contacts serves one set at a time: a second detection before the first set
/// is destroyed is a bug and aborts.
class Contacts {
 public:
  /// `model` must outlive the Contacts, and so must `watch`, if it is not null.
  Contacts(const Model& model, const elements::Kernels& kernels, StageWatch* watch = nullptr);

  /// The pins' contacts in a step of `h` [s] from `position` [m] to the hands at `share` of the tick.
  static Pins pins(const HeldTools& tools, const Vec3Array& position, double share, double h);

  /// Does at once what the first tick with a blade needs.
  void prepare() { cuts_.prepare(); }
  /// Whether begin_tick() will change `state`.
  bool changes(const State& state, bool cuts) const { return cuts_.changes(state, cuts); }
  /// Opens and follows what is cut, at the start of a tick from `state`. `cuts`: a hand holds a blade.
  void begin_tick(State& state, bool cuts) { cuts_.begin_tick(state, cuts); }

  /// Reserves memory for all that can be touched, so that a tick does not allocate unless it touches a cut.
  void reserve(Touched& touched) const;

  /// Detects the contacts of an explicit step in its middle.
  [[nodiscard]] ExplicitContacts detect_in_middle(const StateView& middle, const HeldTools& tools,
                                                  const ContactStep& step);

  /// Detects the contacts of an implicit step.
  [[nodiscard]] ImplicitContacts detect(const StateView& state, const HeldTools& tools, const ContactStep& step,
                                        Linearisation about);

 private:
  friend class ContactSet;
  friend class ExplicitContacts;
  friend class ImplicitContacts;
  friend class LinearisedContacts;

  std::pair<std::size_t, std::size_t> pressed_capacity() const;
  void find(const StateView& state, const HeldTools& tools, const ContactStep& step, bool from_velocity);

  const Model& model_;
  std::vector<surface::Body> bodies_;
  CutSurfaces cuts_;
  BallContact ball_;
  BodyContact body_contact_;
  ObstacleContact obstacles_;
  BladeForce blade_;
  BladeWedge wedge_;
  CutFaceContact cut_faces_;
  PointContacts points_;
  ExplicitSolve explicit_solve_;
  std::optional<OwnMotion> own_motion_;  ///< empty without a ball
  bool is_locked_ = false;               ///< a set exists
  bool is_linearised_ = false;           ///< the set is in a linear system
};

/// The contacts of one step, until it is destroyed. Move-only.
class ContactSet {
 public:
  const ContactStep& step() const { return step_; }
  const PointContacts& points() const { return contacts_->points_; }

  /// Takes the contacts for which `is_left_out` is true out of the set, before it is solved.
  template <class IsLeftOut>
  void leave_out(IsLeftOut&& is_left_out) {
    contacts_->points_.leave_out(is_left_out);
  }

  /// Number of points that the ball in a hand touches; for a blade, of nodes of its edge that tissue holds, and of
  /// those behind which tissue holds its flanks.
  std::int32_t touched(std::size_t hand) const;

  /// Largest displacement from rest [m], at `position`, of a point that the ball in a hand touches, along its contact;
  /// for a pin, that of its sphere. 0 without contact and for a blade. Where nothing holds a piece of tissue, its
  /// motion as a whole does not count.
  double depth(std::size_t hand, const Vec3Array& position) const;

  /// Notes what is touched, with the spheres at `position` [m] and the hands' tools at `centre` [m] at the end of the
  /// substep.
  void note_touched(const std::array<Vec3, kMostHands>& centre, const Vec3Array& position, Touched& touched) const;

 protected:
  ContactSet(Contacts& contacts, const ContactStep& step);

  struct Unlock {
    void operator()(Contacts* contacts) const { contacts->is_locked_ = false; }
  };
  std::unique_ptr<Contacts, Unlock> contacts_;
  ContactStep step_;
};

/// Contacts of an explicit step.
class ExplicitContacts : public ContactSet {
 public:
  /// Changes the `velocity` [m/s] that spheres have after the step without contacts; `before`: that at its start. Those
  /// that would pull do not act.
  void push_apart(const Vec3Array& before, Vec3Array& velocity);

  /// Force of the tissue on the ball or blade in a hand [N].
  Vec3 tool_force(std::size_t hand) const { return tool_force_[hand]; }

 private:
  friend class Contacts;
  ExplicitContacts(Contacts& contacts, const ContactStep& step) : ContactSet(contacts, step) {}

  std::array<Vec3, kMostHands> tool_force_;
};

/// Contacts in the linear system of an implicit step, until it is destroyed. The destructor restores the system to the
/// bit. Velocities `v` [m/s] are the unknowns of the system (3 x sphere_count).
class LinearisedContacts {
 public:
  LinearisedContacts(const LinearisedContacts&) = delete;
  LinearisedContacts& operator=(const LinearisedContacts&) = delete;
  ~LinearisedContacts() { take_back(); }

  /// result += coupling times `v`.
  void apply(const double* v, double* result) const { contacts_.points_.apply(h_, v, result); }

  /// As above without the diagonal that was added to the blocks, in the precision of `v`, float or double.
  template <class Real>
  void apply_lagged(const Real* v, Real* result) const {
    contacts_.points_.apply_lagged(h_, v, result);
  }

  /// Whether a contact pulls, or draws its point too far, in a step with velocity `v`.
  bool has_wrong(const elements::Coordinates& v) const;

  /// Force of the tissue on the ball or blade in a hand [N] after a step with velocity `v`.
  Vec3 tool_force(std::size_t hand, const elements::Coordinates& v) const;

  /// Takes all contacts out of the system, removes from the set those that pull in a step with velocity `v`, and makes
  /// springs of those that draw their point too far.
  void mend_wrong(const elements::Coordinates& v) &&;

 private:
  friend class ImplicitContacts;
  LinearisedContacts(Contacts& contacts, double h, elements::Coordinates& force, elements::DiagonalBlocks& blocks);
  void take_back();

  Contacts& contacts_;
  double h_;
  elements::Coordinates& force_;
  elements::DiagonalBlocks& blocks_;
  bool is_in_system_ = true;
};

/// Contacts of an implicit step.
class ImplicitContacts : public ContactSet {
 public:
  /// Adds the contacts' forces [N] and the diagonal of their coupling to the system of the step, until the result is
  /// destroyed. Until then nothing else may change the system's forces or diagonal.
  [[nodiscard]] LinearisedContacts linearise(elements::Coordinates& force, elements::DiagonalBlocks& blocks) &;

 private:
  friend class Contacts;
  ImplicitContacts(Contacts& contacts, const ContactStep& step) : ContactSet(contacts, step) {}
};

}  // namespace ctpm::contact
