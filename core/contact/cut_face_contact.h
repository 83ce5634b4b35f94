#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/contact/point_contact.h"
#include "core/model/state_view.h"

namespace ctpm::contact {

/// Contact between the two faces of a cut, which keeps them from passing through each other. A sphere is on a cut face
/// if one of its elements is severed. Two such spheres of an organ stay a spacing apart unless an unsevered element
/// joins them. Only spheres on cut faces are checked, sorted along x.
///
/// The force between two centres at a distance d < s is lip_k p (1 + (b p / s)^2), p = s - d, b = cut_face_stiffening.
/// At first it is no stiffer than the severed elements were, so that severing compressed tissue adds no energy. Then it
/// grows so stiff that nothing slips through.
class CutFaceContact {
 public:
  /// Lists each sphere's elements if `model.lip_k` > 0. Otherwise it stores nothing, and nobody calls find().
  explicit CutFaceContact(const Model& model);

  bool is_wanted() const { return model_.lip_k > 0; }

  /// Capacity that find() needs, in contacts.
  std::size_t capacity() const { return is_wanted() ? kMostPerSphere * model_.sphere_count() : 0; }

  /// Adds the contacts of `state`, in an order that depends on it alone.
  void find(const StateView& state, PointContacts& contacts);

 private:
  static constexpr std::size_t kMostPerSphere = 13;  ///< pairs of one sphere closer than a spacing, each pair once

  void gather(const StateView& state);
  bool are_joined(const StateView& state, std::int32_t a, std::int32_t b) const;
  void add_pair(const StateView& state, std::int32_t a, std::int32_t b, PointContacts& contacts) const;

  const Model& model_;
  std::vector<std::int32_t> first_;  ///< where a sphere's entries in joins_ begin (sphere_count + 1)
  struct Join {
    std::int32_t neighbour, element;
  };
  std::vector<Join> joins_;
  std::vector<double> spacing_;           ///< of a sphere's organ [m] (sphere_count)
  std::vector<std::int32_t> organ_;       ///< (sphere_count)
  std::vector<std::uint8_t> is_on_face_;  ///< sphere has a severed element (sphere_count)
  struct Place {
    double x;
    std::int32_t sphere;
  };
  std::vector<Place> on_faces_;  ///< spheres on cut faces, in ascending x
};

}  // namespace ctpm::contact
