#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/contact/point_contact.h"
#include "core/contact/pressed_point.h"
#include "core/model/model.h"
#include "core/model/state_view.h"
#include "core/surface/facets.h"
#include "core/surface/near_surface.h"

namespace ctpm::contact {

/// The surface of one organ as a body that touches obstacles and other bodies.
struct Body {
  std::int32_t organ;         ///< in Model::organs
  std::int32_t first_vertex;  ///< number of its first vertex through all organs
  surface::NearSurface surface;
  surface::Facets facets;
};

/// The bodies of a Model, one for each organ with a surface; none if nothing in it meets (Model::has_meeting_bodies).
std::vector<Body> bodies_of(const Model& model);

/// A vertex of a body that is inside something rigid, or inside other tissue.
struct Overlap {
  std::int32_t facet, vertex;   ///< of the body
  double depth;                 ///< [m]
  Vec3 axis;                    ///< in which the vertex is pushed, unit length
  const Body* other = nullptr;  ///< the other body; null: something rigid
  std::int32_t triangle = -1;   ///< of the other surface, on the axis at the vertex
  double at[3] = {};            ///< barycentric coordinates there [1]
};

/// Turns the overlaps of a body into contacts, one for each facet, at its centre of pressure. The pressure is that of a
/// dent (dent_stiffness); two bodies are dented both, and since each vertex of both is looked at, each counts half.
/// Forces are equal and opposite, on one line.
class FacetPress {
 public:
  explicit FacetPress(const Model& model)
      : model_(model), carriers_(model.has_meeting_bodies() ? model.sphere_count() : 0) {}

  /// Capacity that add() needs for all overlaps of `body`, with other bodies among `bodies` or without: contacts, and
  /// entries of their carriers.
  static std::pair<std::size_t, std::size_t> capacity(const Body& body, const std::vector<Body>& bodies);

  /// Adds the contacts of `overlaps` of `body`, which it sorts and clears, in ascending order of their points.
  /// `first_point`: number in State::touched of the body's first vertex.
  void add(const StateView& state, const PressStep& step, const Body& body, std::int32_t first_point,
           std::vector<Overlap>& overlaps, PointContacts& contacts);

 private:
  void add_facet(const StateView& state, const PressStep& step, const Body& body, std::int32_t point, double radius,
                 std::span<const Overlap> overlaps, PointContacts& contacts);
  double stiffness(const Body& body, double radius) const;

  const Model& model_;
  CarrierSum carriers_;
};

}  // namespace ctpm::contact
