#include "studio/server/scene_text.h"

#include "core/model/box.h"
#include "studio/loading/loaded_scene.h"
#include "studio/server/text.h"
#include "studio/views/look.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::server {
namespace {

void write_colour(output::JsonWriter& json, const char* key, const render::Colour& colour) {
  json.key(key).begin_list();
  for (const double part : colour) json.value(part);
  json.end_list();
}

/// The box around an organ's spheres at rest.
void write_box(output::JsonWriter& json, const Model& model, const OrganRange& organ) {
  Box box(model.rest_position[std::size_t(organ.first)]);
  for (std::int32_t i = organ.first; i < organ.first + organ.count; ++i) box.add(model.rest_position[std::size_t(i)]);
  json.key("least"), write_vector(json, box.low);
  json.key("most"), write_vector(json, box.high);
}

/// Where a tool is taken up, if its author says that.
void write_place(output::JsonWriter& json, const scenes::ToolSpec& tool) {
  if (!tool.at) return;
  json.key("at"), write_vector(json, *tool.at);
  json.key("pointing"), write_vector(json, tool.pointing.value_or(Vec3{0, 0, -1}));
  if (tool.facing) json.key("facing"), write_vector(json, *tool.facing);
}

const char* name_of(ToolKind kind) {
  return kind == ToolKind::ball ? "ball" : kind == ToolKind::scalpel ? "scalpel" : "pin";
}

}  // namespace

void write_camera(output::JsonWriter& json, const std::string& name, const render::Camera& camera) {
  json.begin_object().member("name", name).key("eye");
  write_vector(json, camera.eye);
  json.key("target");
  write_vector(json, camera.target);
  json.key("up");
  write_vector(json, camera.up);
  json.member("fov_deg", camera.fov_deg).end_object();
}

std::string json_text(const std::string& text) {
  output::JsonWriter json;
  std::string quoted = json.value(text).text();
  quoted.pop_back();  // the newline
  return quoted;
}

void write_findings(output::JsonWriter& json, const std::vector<importers::Finding>& findings) {
  json.begin_list();
  for (const importers::Finding& finding : findings)
    json.begin_object()
        .member("code", std::string_view(finding.code))
        .member("found", std::string_view(finding.found))
        .member("done", std::string_view(finding.done))
        .member("remains", std::string_view(finding.remains))
        .end_object();
  json.end_list();
}

void write_tissues(output::JsonWriter& json, const views::OrganTissues& organ) {
  json.key("tissues").begin_list();
  for (const views::TissueOfOrgan& tissue : organ.tissue) {
    json.begin_object().member("text", tissue.text).member("spheres", tissue.spheres);
    write_colour(json, "colour", tissue.colour);
    json.end_object();
  }
  json.end_list();
}

std::string view_json(const scenes::SceneSpec& scene, const Model& model) {
  const render::SceneView view = views::view_of(scene, model);
  output::JsonWriter json;
  json.begin_object().member("name", scene.name).member("task", scene.task).key("organs").begin_list();
  for (std::size_t i = 0; i < model.organs.size(); ++i) {
    const OrganRange& organ = model.organs[i];
    json.begin_object().member("name", organ.name).member("spheres", std::int64_t(organ.count));
    json.member("layers", std::int64_t(organ.layer_count)).member("damage_depth_m", organ.damage_depth);
    if (i < view.looks.size()) {
      write_colour(json, "outer", view.looks[i].outer), write_colour(json, "inner", view.looks[i].inner);
      json.member("wetness", view.looks[i].wetness);
    }
    json.key("layer_colours").begin_list();
    for (int layer = 1; layer <= organ.layer_count; ++layer) {
      json.begin_list();
      for (const double part : render::layer_colour(layer, organ.layer_count)) json.value(part);
      json.end_list();
    }
    json.end_list();
    write_box(json, model, organ);
    json.end_object();
  }
  json.end_list().key("tools").begin_list();
  for (std::size_t i = 0; i < model.tools.size(); ++i) {
    const Tool& tool = model.tools[i];
    json.begin_object().member("name", tool.name).member("kind", name_of(tool.kind));
    json.member("radius_m", tool.radius).member("blade_m", tool.blade_length);
    if (i < scene.tools.size()) write_place(json, scene.tools[i]);
    json.end_object();
  }
  json.end_list().member("hands", std::int64_t(model.hands)).key("cameras").begin_list();
  constexpr double kAspect = 16.0 / 9;
  for (const scenes::CameraSpec& camera : scene.cameras) {
    views::LookRequest request;
    request.camera = camera.name;
    if (const Result<views::Look> look = views::find_look(request, scene, view, kAspect))
      write_camera(json, camera.name, look->draw.camera);
  }
  write_camera(json, "fitted", render::default_camera(view, kAspect));
  json.end_list().member("damage_force_n", loading::damage_force_of(scene));
  const render::Bounds bounds = render::rest_bounds(view);
  json.key("least"), write_vector(json, bounds.min);
  json.key("most"), write_vector(json, bounds.max);
  json.key("up"), write_vector(json, render::up_of(model));
  return json.end_object().text();
}

}  // namespace ctpm::server
