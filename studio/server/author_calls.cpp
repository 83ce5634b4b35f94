#include <filesystem>
#include <string>

#include "core/model/state.h"
#include "recordings/byte_hash.h"
#include "scenes/presets.h"
#include "scenes/scene_file.h"
#include "studio/authoring/import_scene.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/files.h"
#include "studio/server/call_table.h"
#include "studio/server/picture.h"
#include "studio/server/scene_text.h"

namespace ctpm::server {
namespace {

constexpr const char* kNoFile = "none";  ///< revision of a file that is not there

std::string revision_of(const std::string& text) {
  recordings::ByteHash hash;
  hash.add(text.data(), text.size());
  return recordings::hash_text(hash.value());
}

Result<std::string> place_of_scene(const Folder& folder, const std::string& path) {
  if (!path.ends_with(".json")) return Error{path, "a scene's name must end in .json", ""};
  return folder.place(path);
}

std::string errors_json(const Errors& errors) {
  output::JsonWriter json;
  write_errors(json, errors);
  return json.text();
}

}  // namespace

Result<std::string> read_scene(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = context.folder.find(path);
  if (!file) return file.errors();
  const Result<std::string> text = output::read_text_file(*file);
  if (!text) return text.errors();
  return "{\"text\": " + json_text(*text) + ", \"revision\": " + json_text(revision_of(*text)) + "}";
}

Result<std::string> write_scene(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path"), text = parameters.text("text");
  const std::string revision = parameters.text("revision");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = place_of_scene(context.folder, path);
  if (!file) return file.errors();
  std::error_code ignored;
  std::string present = kNoFile;
  if (std::filesystem::exists(*file, ignored)) {
    const Result<std::string> before = output::read_text_file(*file);
    if (!before) return before.errors();
    present = revision_of(*before);
  }
  if (present != revision)
    return Error{path, "was changed on the disk since it was read; nothing was written", "read it again"};
  if (const Result<Done> written = output::write_text_file(*file, text); !written) return written.errors();
  return "{\"revision\": " + json_text(revision_of(text)) + "}";
}

Result<std::string> check_scene(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path"), text = parameters.text("text");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  if (const Result<std::string> file = place_of_scene(context.folder, path); !file) return file.errors();
  const Result<scenes::SceneText> scene = scenes::read_scene(text, path);
  return "{\"errors\": " + errors_json(scene ? Errors{} : scene.errors()) +
         ", \"warnings\": " + errors_json(scene ? scene->warnings : Errors{}) + "}";
}

/// Loads a scene with its meshes, as `check` does, and shows it at rest.
Result<std::string> show_scene(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path");
  const std::uint32_t stage = std::uint32_t(parameters.number("stage", 0, Desk::kMostStages - 1));
  if (!context.desk) parameters.refuse("stage", "only a page with a WebSocket has stages");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = context.folder.find(path);
  if (!file) return file.errors();
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(*file);
  if (!scene) return scene.errors();
  const Model& model = scene->built.model;
  PictureMaker maker(model, stage);
  context.desk->outbox().send_bytes(tools_message(model, stage));
  context.desk->outbox().show(maker.make(rest_state(model), {}));
  output::JsonWriter json;
  json.begin_list();
  for (std::size_t i = 0; i < scene->organs.size(); ++i) {
    const bool has_mesh = i < scene->reports.size() && !scene->reports[i].path.empty();
    json.begin_object()
        .member("spheres", scene->organs[i].centre.size())
        .member("report", has_mesh ? importers::to_text(scene->reports[i]) : std::string())
        .end_object();
  }
  json.end_list();
  return "{\"view\": " + view_json(scene->scene.spec, model) + ", \"organs\": " + json.text() +
         ", \"spheres\": " + std::to_string(model.sphere_count()) +
         ", \"elements\": " + std::to_string(model.element_count()) +
         ", \"warnings\": " + errors_json(scene->scene.warnings) + "}";
}

Result<std::string> import_mesh(Parameters& parameters, const CallContext& context) {
  const std::string mesh = parameters.text("mesh"), scene = parameters.text("scene");
  authoring::ImportRequest request;
  request.organ = parameters.text_if("organ").value_or("");
  request.unit_in_metres = parameters.number_if("unit_m", 1e-6, 10);
  request.sphere_radius = parameters.number_if("radius_m", 1e-5, 0.1);
  request.gap = parameters.number_if("gap_m", 0, 0.1);
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = context.folder.find(mesh), place = place_of_scene(context.folder, scene);
  for (const auto* path : {&file, &place})
    if (!*path) return path->errors();
  std::error_code ignored;
  if (std::filesystem::exists(*place, ignored)) return Error{scene, "exists already", "choose another name"};
  request.mesh = *file, request.scene = *place;
  request.progress = [&](const std::string&, double share) { context.progress(std::int64_t(1000 * share), 1000); };
  const Result<authoring::ImportOutcome> outcome = authoring::import_scene(request);
  if (!outcome) return outcome.errors();
  output::JsonWriter json;
  json.begin_object()
      .member("scene", std::string_view(scene))
      .member("script", context.folder.relative(outcome->script_file))
      .member("report", importers::to_text(outcome->report))
      .member("spheres", outcome->report.fill.spheres)
      .member("anchored", outcome->anchored);
  if (outcome->stiffness_scale) json.member("stiffness_scale", *outcome->stiffness_scale);
  json.member("fit_problem", std::string_view(outcome->fit_problem));
  return json.end_object().text();
}

Result<std::string> list_presets(Parameters& parameters, const CallContext&) {
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  output::JsonWriter json;
  json.begin_list();
  for (const scenes::MaterialPreset& preset : scenes::material_presets())
    json.begin_object()
        .member("name", std::string(preset.name))
        .member("organ", std::string(preset.organ))
        .member("radius_m", preset.sphere_radius)
        .end_object();
  return json.end_list().text();
}

}  // namespace ctpm::server
