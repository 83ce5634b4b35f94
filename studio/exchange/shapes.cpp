#include "studio/exchange/shapes.h"

#include "core/surface/surface.h"

namespace ctpm::exchange {

Shaper::Shaper(const Model& model, const scenes::SceneSpec& scene) : model_(model) {
  for (std::size_t o = 0; o < model.surfaces.size(); ++o) {
    if (model.surfaces[o].triangle.empty()) continue;
    const Vec3 colour = o < scene.organs.size() ? scene.organs[o].surface_color : scenes::OrganSpec{}.surface_color;
    organs_.push_back({o, nullptr, {colour.x, colour.y, colour.z}});
    if (model.has_scalpel()) organs_.back().body = std::make_unique<cutbody::CutBody>(model, o);
  }
}

std::vector<OrganShape> Shaper::shapes(const State& state) {
  std::vector<OrganShape> shapes;
  for (Organ& organ : organs_) {
    if (organ.body && organ.body->update(state)) ++organ.revision;
    const Surface& surface = organ.body ? organ.body->surface() : model_.surfaces[organ.index];
    OrganShape& shape = shapes.emplace_back();
    shape.name = model_.organs[organ.index].name;
    shape.colour = organ.colour, shape.revision = organ.revision;
    shape.rest = surface.vertex, shape.triangle = surface.triangle;
    shape.outer_triangles = organ.body ? organ.body->outer_triangle_count() : surface.triangle.size();
    surface::deform_surface(surface, state.position, model_.organs[organ.index].first, shape.vertex);
  }
  return shapes;
}

}  // namespace ctpm::exchange
