#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/contact/cut_surfaces.h"
#include "core/contact/near_triangles.h"
#include "core/contact/point_contact.h"
#include "core/contact/pressed_point.h"
#include "core/elements/kernels/kernels.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/surface/bodies.h"
#include "core/surface/near_surface.h"

namespace ctpm::contact {

/// A ball in one step.
struct BallMotion {
  Vec3 centre;    ///< at detection [m]
  Vec3 velocity;  ///< [m/s]
  double radius;  ///< [m]
  PressStep step;
  std::size_t hand = 0;  ///< that holds it
};

/// Contact of a rigid ball with the surfaces of organs: no part of a surface is inside the ball. Where the surface that
/// the lattice carries would be, the ball dents it, with a pressure of dent_stiffness() times the dent's depth, which
/// relaxes as the tissue does (Foundation). The depth is measured inwards from the surface to the far side of the ball,
/// and counts across the ball there; small balls may therefore go deeper than the lattice follows. The pressure is
/// integrated over the triangles and gathered at their corners, or at one of those that are nearer to each other than
/// spheres and ball resolve (Gathering), one contact each; from there it goes to the spheres with the weights of the
/// binding.
///
/// Organs without a surface (rigs) are touched at their spheres, with Model::contact_k each, and damped as Hunt &
/// Crossley say (contact_damping).
///
/// Friction holds each point at a place on the ball, up to the friction cone (pressed_point.h).
///
/// Two hands may hold a ball each. Each presses by itself, and State tells by the numbers of the points which ball
/// touches them.
class BallContact {
 public:
  /// `bodies`, those of the Model, and `cuts` must outlive the BallContact.
  BallContact(const Model& model, std::vector<surface::Body>& bodies, CutSurfaces& cuts,
              const elements::Kernels& kernels);

  /// Capacity that find() needs for one ball: contacts, and entries of their carriers.
  std::pair<std::size_t, std::size_t> capacity() const { return capacity_; }

  /// Adds the contacts of a ball, in ascending order of their points. A round of the bodies' surfaces must have begun.
  void find(const StateView& state, const BallMotion& ball, PointContacts& contacts);

  /// Depth of the dent under a contact [m], 0 for that of a bare sphere.
  double dent_of(const PointContact& contact) const {
    return cuts_.points().contains(contact.point) || number_of(contact) < vertex_count_ ? contact.dent : 0.0;
  }

  /// Where the tissue was at rest that a contact touches [m].
  Vec3 rest_of(const PointContact& contact) const;

 private:
  /// What presses on one vertex of a surface.
  struct Pressed {
    double area = 0;  ///< that the vertex stands for, under the ball [m^2]
    Vec3 volume;      ///< depth times area, along the ball's radius [m^3]
  };

  /// Number of the first point that the ball in a hand may touch, and of those before a contact's.
  std::int32_t first_point_of(std::size_t hand) const { return cuts_.points().kind_of_ball(hand) * touchable_count_; }
  std::int32_t number_of(const PointContact& contact) const {
    return contact.point - first_point_of(std::size_t(contact.hand));
  }
  Reach reach_of(const StateView& state, const BallMotion& ball);
  using Part = BallPart;

  const Part& part_of(std::int32_t slot) const;
  std::int32_t organ_of(const Part& part, std::int32_t slot) const;
  surface::Follower follower(std::int32_t slot) const;
  Vec3 carried(std::int32_t slot) const;
  void mark_touched(const StateView& state, const BallMotion& ball, std::uint8_t value);
  bool may_be_hidden(const Part& part, const surface::NearSurface::Triangle& triangle) const;
  bool is_hidden(const Part& part, const surface::NearSurface::Triangle& triangle, const double* weights) const;
  double share_of(const Part& part, std::int32_t slot, double radius);
  bool dent(const Part& part, const surface::NearSurface::Triangle& triangle, const BallMotion& ball, double reach,
            bool behind, double apart);
  void dent_behind(const BallMotion& ball, double reach);
  bool is_inside(std::int32_t organ, Vec3 point);
  void press_slot(const StateView& state, const BallMotion& ball, std::int32_t slot, double radius,
                  PointContacts& contacts);
  void find_on_surfaces(const StateView& state, const BallMotion& ball, PointContacts& contacts);
  void find_on_spheres(const StateView& state, const BallMotion& ball, PointContacts& contacts);
  void add(const StateView& state, const BallMotion& ball, PointContact contact, Carriers carriers, Vec3 place,
           PointContacts& contacts) const;

  const Model& model_;
  const elements::Kernels& kernels_;
  CutSurfaces& cuts_;
  surface::NearSurface own_;                  ///< all organs as one; empty where there are bodies
  surface::Gathering gathering_;              ///< of the vertices through all organs
  std::vector<Part> whole_;                   ///< own_, or the surfaces of the bodies
  std::vector<NearTriangles> near_;           ///< of the ball in each hand
  const std::vector<Part>* parts_ = &whole_;  ///< in find() with patches of cuts
  std::int32_t vertex_count_ = 0, touchable_count_ = 0;
  std::vector<std::int32_t> organ_of_;        ///< (vertex_count)
  std::vector<Pressed> pressed_;              ///< (slot_count, like the next: vertices, and in find() those of patches)
  std::vector<std::uint8_t> was_touched_;     ///< at the start of the substep
  std::vector<double> opening_;               ///< at the vertices of patches [m]
  std::vector<std::int32_t> touched_;         ///< slots with an area
  std::vector<NearTriangles::Found> behind_;  ///< triangles with parts that face away from the ball's centre
  Vec3 pressed_area_;                         ///< sum over the pressed areas, each along the ball's radius [m^2]
  /// Spheres [first, last) of the organs without a surface.
  std::vector<std::pair<std::size_t, std::size_t>> bare_;
  double largest_radius_ = 0;  ///< of a sphere [m]
  std::pair<std::size_t, std::size_t> capacity_{};
};

}  // namespace ctpm::contact
