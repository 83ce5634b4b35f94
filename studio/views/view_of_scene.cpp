#include "studio/views/view_of_scene.h"

#include <utility>

namespace ctpm::views {

render::SceneView view_of(const scenes::SceneSpec& scene, const Model& model) {
  render::SceneView view;
  view.model = &model;
  for (const scenes::OrganSpec& organ : scene.organs) {
    render::OrganLook look = render::look_of(organ.name);
    look.name = organ.name;
    look.outer = {organ.surface_color.x, organ.surface_color.y, organ.surface_color.z};
    look.inner = {organ.inner_color.x, organ.inner_color.y, organ.inner_color.z};
    view.looks.push_back(look);
  }
  return view;
}

}  // namespace ctpm::views
