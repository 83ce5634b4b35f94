#pragma once

#include <utility>
#include <vector>

#include "core/contact/cut_overlaps.h"
#include "core/contact/facet_press.h"
#include "core/contact/point_contact.h"
#include "core/contact/pressed_point.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/surface/bodies.h"
#include "core/surface/body_overlaps.h"

namespace ctpm::contact {

/// Contact between the surfaces of organs (Model::organs_meet), and of an organ's surface with itself
/// (OrganRange::meets_itself), where they overlap (surface::BodyOverlaps). Of an organ that meets itself, pieces that a
/// cut has parted meet, too (CutOverlaps).
class BodyContact {
 public:
  /// `bodies` and `cuts` must outlive the BodyContact.
  BodyContact(const Model& model, std::vector<surface::Body>& bodies, CutSurfaces& cuts);

  /// Capacity that find() needs: contacts, and entries of their carriers.
  std::pair<std::size_t, std::size_t> capacity() const { return capacity_; }

  /// Adds the contacts, in ascending order of their points. A round of the bodies' surfaces must have begun.
  void find(const StateView& state, const PressStep& step, PointContacts& contacts);

 private:
  const Model& model_;
  std::vector<surface::Body>& bodies_;
  FacetPress press_;
  CutSurfaces& cuts_;
  surface::BodyOverlaps overlaps_;
  CutOverlaps cut_overlaps_;
  std::vector<surface::Overlap> found_, found_on_patches_;
  std::pair<std::size_t, std::size_t> capacity_{};
};

}  // namespace ctpm::contact
