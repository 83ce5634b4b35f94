#include "core/surface/bodies.h"

namespace ctpm::surface {
std::vector<Body> bodies_of(const Model& model) {
  std::vector<Body> bodies;
  if (!model.has_meeting_bodies()) return bodies;
  std::size_t first_vertex = 0;
  for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
    const Surface& surface = model.surfaces[i];
    if (!surface.triangle.empty())
      bodies.push_back({std::int32_t(i), std::int32_t(first_vertex), NearSurface(model, i, i + 1),
                        Facets(surface, kFacetRadius * model.organs[i].spacing)});
    first_vertex += surface.vertex.size();
  }
  return bodies;
}

}  // namespace ctpm::surface
