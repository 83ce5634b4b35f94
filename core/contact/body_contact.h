#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/contact/facet_press.h"
#include "core/contact/point_contact.h"
#include "core/contact/pressed_point.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/surface/near_patches.h"

namespace ctpm::contact {

/// Contact between the surfaces of organs (Model::organs_meet), and of an organ's surface with itself
/// (OrganRange::meets_itself). A vertex is inside other tissue if the line from it inwards leaves that tissue before
/// anything else; how far it goes until then is the depth of the overlap. Of its own surface, a vertex meets only parts
/// that were at rest much farther away than the overlap is deep, so that an organ does not meet its own far side.
class BodyContact {
 public:
  /// `bodies` must outlive the BodyContact.
  BodyContact(const Model& model, std::vector<Body>& bodies);

  /// Capacity that find() needs: contacts, and entries of their carriers.
  std::pair<std::size_t, std::size_t> capacity() const { return capacity_; }

  /// Adds the contacts, in ascending order of their points.
  void find(const StateView& state, const PressStep& step, PointContacts& contacts);

  struct Deepest {
    std::int32_t organ, other;  ///< in Model::organs
    double depth;               ///< [m]
    Vec3 place;                 ///< of the first organ's surface [m]
  };
  /// The deepest overlap with the spheres at `position`, among those that find() would push apart.
  std::optional<Deepest> deepest(const Vec3Array& position);

 private:
  /// Where the line inwards from a vertex first meets a surface.
  struct Hit {
    std::uint32_t round = 0;  ///< in which it was found; the rest counts in that one only
    double distance;          ///< along the line [m]
    Vec3 inwards;             ///< direction of the line
    const Body* body;
    std::int32_t triangle;
    double at[3];  ///< barycentric coordinates
    bool is_exit;  ///< the line leaves the tissue there
  };

  void begin(const Vec3Array& position);
  void find_overlaps(const Vec3Array& position, std::size_t body);
  bool may_meet(std::size_t body, std::size_t other) const;
  double reach_of(std::size_t body, std::size_t other) const;
  void look(const Vec3Array& position, std::size_t body, std::size_t other);
  void look_at_patches(const Vec3Array& position, std::size_t body, std::int32_t patch, std::size_t other,
                       std::int32_t other_patch);
  void meet(const Vec3Array& position, Vec3 from, double reach, Body& other, std::int32_t triangle, Hit& hit);
  bool is_far_at_rest(const Body& body, std::int32_t vertex, const Hit& hit) const;

  const Model& model_;
  std::vector<Body>& bodies_;
  FacetPress press_;
  std::vector<surface::NearPatches> patches_;  ///< of each body
  std::vector<Hit> hits_;                      ///< of the vertices of one body
  std::vector<std::int32_t> hit_vertices_;     ///< with a hit, or looked at without one
  std::uint32_t round_ = 0;
  std::vector<Overlap> overlaps_;
  std::pair<std::size_t, std::size_t> capacity_{};
};

}  // namespace ctpm::contact
