#include "studio/loading/loaded_scene.h"

#include "scenes/presets.h"

namespace ctpm {
namespace {

ImportOptions import_options_of(const OrganSpec& organ) {
  ImportOptions options;
  options.unit_in_metres = metres_of(organ.mesh_unit);
  if (const MaterialPreset* preset = find_preset(organ.material.preset))
    options.usual_size = {preset->usual_size_least, preset->usual_size_most};
  options.sphere_radius = organ.fill.radius;
  options.gap = organ.fill.gap;
  options.all_parts = organ.all_parts;
  options.most_triangles = organ.most_triangles.value_or(0);
  return options;
}

}  // namespace

Result<ImportedOrgan> fill_of(const std::string& scene_path, const OrganSpec& organ) {
  if (!organ.rig) return import_organ(mesh_path(scene_path, organ), import_options_of(organ));
  // A rig has no mesh; its surface is empty and bound to nothing.
  ImportedOrgan filled;
  filled.organ = fill_rig(organ);
  filled.organ.surface.binding.first = {0};
  return filled;
}

Result<LoadedScene> load_whole_scene(const std::string& path, const LoadOptions& options,
                                     const std::function<void(SceneSpec&)>& change, const TakeWarning& take_warning) {
  Result<SceneText> scene = load_scene(path, options);
  if (!scene) return scene.errors();
  if (take_warning)
    for (const Error& warning : scene->warnings) take_warning(warning);
  LoadedScene loaded;
  loaded.path = path;
  loaded.scene = std::move(*scene);
  if (change) change(loaded.scene.spec);
  Errors errors;
  for (const OrganSpec& organ : loaded.scene.spec.organs) {
    Result<ImportedOrgan> imported = fill_of(path, organ);
    if (!imported) {
      errors.insert(errors.end(), imported.errors().begin(), imported.errors().end());
      continue;
    }
    loaded.organs.push_back(std::move(imported->organ));
    loaded.reports.push_back(std::move(imported->report));
  }
  if (!errors.empty()) return errors;
  Result<BuiltScene> built = build_model(loaded.scene.spec, loaded.organs);
  if (!built) {
    for (Error error : built.errors()) {
      error.where = path + ": " + error.where;
      errors.push_back(error);
    }
    return errors;
  }
  loaded.built = std::move(*built);
  return loaded;
}

Result<BuiltScene> build_changed(const LoadedScene& scene, const std::function<void(SceneSpec&)>& change) {
  SceneSpec spec = scene.scene.spec;
  change(spec);
  return build_model(spec, scene.organs);
}

std::vector<Surface> surfaces_of(const std::vector<FilledOrgan>& organs) {
  std::vector<Surface> surfaces;
  for (const FilledOrgan& organ : organs) surfaces.push_back(organ.surface);
  return surfaces;
}

double damage_force_of(const SceneSpec& scene) {
  double least = 0;
  for (const OrganSpec& organ : scene.organs)
    if (organ.damage_force > 0 && (least == 0 || organ.damage_force < least)) least = organ.damage_force;
  return least;
}

}  // namespace ctpm
