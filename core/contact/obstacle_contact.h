#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/contact/cut_surfaces.h"
#include "core/contact/facet_press.h"
#include "core/contact/near_obstacle.h"
#include "core/contact/point_contact.h"
#include "core/contact/pressed_point.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/surface/obstacle_shape.h"

namespace ctpm::contact {

/// Contact of tissue with obstacles: of the surfaces of organs, and of the spheres of organs without one, at
/// Model::contact_radius and with Model::contact_k each.
class ObstacleContact {
 public:
  /// `bodies` and `cuts` must outlive the ObstacleContact.
  ObstacleContact(const Model& model, std::vector<surface::Body>& bodies, CutSurfaces& cuts);

  /// Capacity that find() needs: contacts, and entries of their carriers.
  std::pair<std::size_t, std::size_t> capacity() const { return capacity_; }

  /// Adds the contacts, in ascending order of their points. A round of the bodies' surfaces must have begun.
  void find(const StateView& state, const PressStep& step, PointContacts& contacts);

 private:
  void find_on_surface(const StateView& state, const PressStep& step, std::size_t obstacle, surface::Body& body,
                       PointContacts& contacts);
  void find_on_spheres(const StateView& state, const PressStep& step, const surface::ObstacleShape& shape,
                       std::int32_t first_point, PointContacts& contacts) const;

  const Model& model_;
  std::vector<surface::Body>& bodies_;
  CutSurfaces& cuts_;
  FacetPress press_;
  std::vector<surface::ObstacleShape> shapes_;  ///< of Model::obstacles
  std::vector<NearObstacle> near_;              ///< by obstacle, for each of the bodies
  std::int32_t vertex_count_ = 0;               ///< through all organs
  std::vector<std::int32_t> bare_;              ///< spheres of organs without a surface
  std::vector<surface::Overlap> overlaps_;
  /// A patch, and which of the overlaps are its.
  struct PatchOverlaps {
    cutbody::CutPatch* patch;
    std::size_t first, last;
  };
  std::vector<PatchOverlaps> patches_;
  std::pair<std::size_t, std::size_t> capacity_{};
};

}  // namespace ctpm::contact
