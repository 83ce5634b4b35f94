#include "studio/views/view_of_scene.h"

#include <utility>

namespace ctpm {

SceneView view_of(const SceneSpec& scene, const Model& model, std::vector<Surface> surfaces) {
  SceneView view;
  view.model = &model;
  view.surfaces = std::move(surfaces);
  for (const OrganSpec& organ : scene.organs) {
    OrganLook look = look_of(organ.name);
    look.name = organ.name;
    look.outer = {organ.surface_color.x, organ.surface_color.y, organ.surface_color.z};
    look.inner = {organ.inner_color.x, organ.inner_color.y, organ.inner_color.z};
    view.looks.push_back(look);
  }
  return view;
}

}  // namespace ctpm
