#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/contact/point_contact.h"
#include "core/contact/pressed_point.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/surface/bodies.h"
#include "core/surface/body_overlaps.h"

namespace ctpm::contact {

/// Area of all overlaps of `body` [m^2], and radius of a disc of it [m].
double area_of(const surface::Body& body, std::span<const surface::Overlap> overlaps);
double radius_of(double area);
double radius_of(const surface::Body& body, std::span<const surface::Overlap> overlaps);

/// Part of an overlap of `body` with `other` by which `body` is dented; `other` is by the rest. `radius` [m]: as above.
double share_of_dent(const Model& model, const surface::Body& body, const surface::Body& other, double radius);

/// Turns the overlaps of a body into contacts, one for each facet, at its centre of pressure. The pressure is that of a
/// dent (dent_stiffness); two bodies are dented both, and since each vertex of both is looked at, each counts half.
/// Forces are equal and opposite, at one place, where the two dents meet.
class FacetPress {
 public:
  explicit FacetPress(const Model& model)
      : model_(model),
        carriers_(model.has_meeting_bodies() ? model.sphere_count() : 0),
        others_(model.has_meeting_tissue() ? model.sphere_count() : 0) {}

  /// Capacity that add() needs for all overlaps of `body`, with other bodies among `bodies` or without: contacts, and
  /// entries of their carriers.
  static std::pair<std::size_t, std::size_t> capacity(const surface::Body& body,
                                                      const std::vector<surface::Body>& bodies);

  /// Adds the contacts of `overlaps` of `body`, which it sorts, in ascending order of their points. `first_point`:
  /// number in State::touched of the body's first vertex. `radius` [m]: of all that is touched there with them.
  void add(const StateView& state, const PressStep& step, const surface::Body& body, std::int32_t first_point,
           std::span<surface::Overlap> overlaps, double radius, PointContacts& contacts);

 private:
  void add_facet(const StateView& state, const PressStep& step, const surface::Body& body, std::int32_t point,
                 double radius, std::span<const surface::Overlap> overlaps, PointContacts& contacts);
  void add_carriers(const StateView& state, double radius, const surface::Body& body,
                    std::span<const surface::Overlap> overlaps);

  const Model& model_;
  CarrierSum carriers_, others_;  ///< of a facet; of what it touches
};

}  // namespace ctpm::contact
