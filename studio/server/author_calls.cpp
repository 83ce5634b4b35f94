#include <algorithm>
#include <filesystem>
#include <string>

#include "importers/formats.h"
#include "recordings/byte_hash.h"
#include "scenes/presets.h"
#include "scenes/scene_file.h"
#include "scenes/schema.h"
#include "studio/authoring/fit_scene.h"
#include "studio/authoring/import_scene.h"
#include "studio/authoring/scene_parts.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/files.h"
#include "studio/server/call_table.h"
#include "studio/server/naming_files.h"
#include "studio/server/scene_list.h"
#include "studio/server/scene_text.h"

namespace ctpm::server {
namespace {

constexpr const char* kNoFile = "none";  ///< revision of a file that is not there

std::string revision_of(const std::string& text) {
  recordings::ByteHash hash;
  hash.add(text.data(), text.size());
  return recordings::hash_text(hash.value());
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
  if (present != revision && revision == kNoFile)
    return Error{path, "exists already; nothing was written", "choose another name"};
  if (present != revision)
    return Error{path, "was changed on the disk since it was read; nothing was written", "read it again"};
  if (const Result<Done> written = output::write_text_file(*file, text); !written) return written.errors();
  return "{\"revision\": " + json_text(revision_of(text)) + "}";
}

Result<std::string> check_scene(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path"), text = parameters.text("text");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  if (const Result<std::string> file = place_of_scene(context.folder, path); !file) return file.errors();
  const Result<scenes::SceneDraft> draft = scenes::read_draft(text, path);
  return "{\"errors\": " + errors_json(draft ? draft->problems.errors() : draft.errors()) +
         ", \"warnings\": " + errors_json(draft ? draft->scene.warnings : Errors{}) + "}";
}

Result<std::string> name_import(Parameters& parameters, const CallContext& context) {
  const std::string wanted = parameters.text("path");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> name = context.folder.free_name(wanted, [](const std::string& scene) {
    const std::vector<std::string> files = authoring::files_of_import(scene);
    std::error_code ignored;
    return std::any_of(files.begin(), files.end(),
                       [&](const std::string& file) { return std::filesystem::exists(file, ignored); });
  });
  if (!name) return name.errors();
  return "{\"path\": " + json_text(*name) + "}";
}

Result<std::string> import_mesh(Parameters& parameters, const CallContext& context) {
  const std::string mesh = parameters.text("mesh"), scene = parameters.text("scene");
  const Result<std::string> file = context.folder.find(mesh);
  const bool is_upload = file && context.uploads && context.uploads->holds(*file);
  if (is_upload && context.desk) context.desk->take_charge(*file);
  authoring::ImportRequest request;
  request.organ = parameters.text_if("organ").value_or("");
  request.unit_in_metres = parameters.number_if("unit_m", 1e-6, 10);
  request.sphere_radius = parameters.number_if("radius_m", 1e-5, 0.1);
  request.gap = parameters.number_if("gap_m", 0, 0.1);
  request.largest_hole = parameters.number_if("largest_hole_m", 0, 10);
  request.names = parameters.texts_if("names");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> place = place_of_scene(context.folder, scene);
  for (const auto* path : {&file, &place})
    if (!*path) return path->errors();
  std::error_code ignored;
  if (std::filesystem::exists(*place, ignored)) return Error{scene, "exists already", "choose another name"};
  request.mesh = *file, request.scene = *place;
  request.progress = [&](const std::string&, double share) { context.progress(std::int64_t(1000 * share), 1000); };
  request.should_stop = context.should_stop;
  const Result<authoring::ImportOutcome> outcome = authoring::import_scene(request);
  if (!outcome) return outcome.errors();
  if (is_upload) remove_unused_upload(context.folder, *context.uploads, *file);
  output::JsonWriter json;
  // Of several organs, the page shows the largest one's figures and all findings, and has the box around all.
  const authoring::ImportedPart& organ = outcome->organs.front();
  std::string reports;
  std::vector<importers::Finding> findings;
  std::size_t anchored = 0;
  std::int64_t spheres = 0;
  Vec3 least = organ.report.box_least, most = organ.report.box_most;
  for (const authoring::ImportedPart& one : outcome->organs) {
    reports += importers::to_text(one.report);
    findings.insert(findings.end(), one.report.findings.begin(), one.report.findings.end());
    anchored += one.anchored, spheres += one.report.fill.spheres;
    const Vec3 low = one.report.box_least, high = one.report.box_most;
    least = {std::min(least.x, low.x), std::min(least.y, low.y), std::min(least.z, low.z)};
    most = {std::max(most.x, high.x), std::max(most.y, high.y), std::max(most.z, high.z)};
  }
  json.begin_object()
      .member("scene", std::string_view(scene))
      .member("script", context.folder.relative(outcome->script_file))
      .member("report", reports)
      .member("unit", importers::unit_name(organ.report.unit.in_metres))
      .member("spheres", spheres)
      .member("anchored", anchored);
  if (organ.stiffness_scale) json.member("stiffness_scale", *organ.stiffness_scale);
  json.member("fit_problem", std::string_view(organ.fit_problem)).key("findings");
  write_findings(json, findings);
  json.key("least"), write_vector(json, least);
  json.key("most"), write_vector(json, most);
  return json.end_object().text();
}

/// The stiffness of an organ, fitted for its spheres as `fit` does it.
Result<std::string> fit_organ(Parameters& parameters, const CallContext& context) {
  const std::string path = parameters.text("path"), organ = parameters.text_if("organ").value_or("");
  scenes::LoadOptions options;
  options.text = parameters.text_if("text");
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  const Result<std::string> file = options.text ? context.folder.place(path) : context.folder.find(path);
  if (!file) return file.errors();
  const Result<loading::LoadedScene> scene = loading::load_whole_scene(*file, options, {}, context.should_stop);
  if (!scene) return scene.errors();
  const Result<authoring::SceneFit> fit = authoring::fit_scene(*scene, organ, context.should_stop, context.progress);
  if (!fit) return fit.errors();
  output::JsonWriter json;
  json.begin_object()
      .member("text", std::string_view(fit->text))
      .member("stiffness_scale", fit->fit.scale)
      .member("is_of_table", fit->is_of_table)
      .key("rows")
      .begin_list();
  for (const authoring::FitRow& row : fit->fit.rows)
    json.begin_object()
        .member("depth_m", row.depth)
        .member("force_n", row.force)
        .member("scatter", row.scatter)
        .member("closed_form_n", row.closed_form)
        .member("error", row.error())
        .end_object();
  return json.end_list().end_object().text();
}

Result<std::string> show_schema(Parameters& parameters, const CallContext&) {
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  return scenes::scene_schema();
}

Result<std::string> list_formats(Parameters& parameters, const CallContext&) {
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  output::JsonWriter json;
  json.begin_list();
  for (const std::string& ending : importers::readable_endings()) json.value(std::string_view(ending));
  return json.end_list().text();
}

Result<std::string> list_presets(Parameters& parameters, const CallContext&) {
  if (const Errors errors = parameters.errors(); !errors.empty()) return errors;
  output::JsonWriter json;
  json.begin_list();
  for (const scenes::MaterialPreset& preset : scenes::material_presets())
    json.begin_object()
        .member("name", std::string(preset.name))
        .member("organ", std::string(preset.organ))
        .member("source", std::string_view(preset.source))
        .member("radius_m", preset.sphere_radius)
        .end_object();
  return json.end_list().text();
}

}  // namespace ctpm::server
