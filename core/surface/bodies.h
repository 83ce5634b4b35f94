#pragma once

#include <cstdint>
#include <vector>

#include "core/model/model.h"
#include "core/surface/facets.h"
#include "core/surface/near_surface.h"

namespace ctpm::surface {

/// Radius of a facet, in spacings (our choice): the spheres do not resolve a pressure over less.
inline constexpr double kFacetRadius = 0.5;

/// The surface of one organ as a body that touches obstacles and other bodies.
struct Body {
  std::int32_t organ;         ///< in Model::organs
  std::int32_t first_vertex;  ///< number of its first vertex through all organs
  NearSurface surface;
  Facets facets;
};

/// The bodies of a Model, one for each organ with a surface; none if nothing in it meets (Model::has_meeting_bodies).
/// `model` must outlive them.
std::vector<Body> bodies_of(const Model& model);

}  // namespace ctpm::surface
