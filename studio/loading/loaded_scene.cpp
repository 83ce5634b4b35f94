#include "studio/loading/loaded_scene.h"

#include <algorithm>
#include <optional>

#include "scenes/presets.h"

namespace ctpm::loading {
namespace {

importers::ImportOptions import_options_of(const scenes::OrganSpec& organ) {
  importers::ImportOptions options;
  options.unit_in_metres = scenes::metres_of(organ.mesh_unit);
  options.turn = organ.turn, options.scale = organ.scale;
  if (const scenes::MaterialPreset* preset = scenes::find_preset(organ.material.preset))
    options.usual_size = {preset->usual_size_least, preset->usual_size_most};
  options.sphere_radius = organ.fill.radius;
  options.gap = organ.fill.gap;
  options.all_parts = organ.all_parts;
  options.most_triangles = organ.most_triangles.value_or(0);
  return options;
}

void move(importers::ImportedOrgan& imported, Vec3 by) {
  move_organ(imported.organ, by);
  for (Vec3& place : imported.mesh.vertex) place = place + by;
  for (Vec3* corner : {&imported.mesh.box_least, &imported.mesh.box_most}) *corner = *corner + by;
}

/// The errors of a mesh, at the place where the scene names it: in `list`, an organ or an obstacle.
void add_mesh_errors(scenes::Problems& problems, const std::string& list, std::size_t index, const Errors& errors) {
  const std::string at = list + "/" + std::to_string(index) + "/mesh";
  for (const Error& error : errors)
    problems.add(at, (error.where.empty() ? "" : error.where + ": ") + error.message, error.hint, at);
}

/// Finds places on filled organs; those without spheres are not known.
scenes::PlaceFinder finder_on(const scenes::SceneSpec& scene, const std::vector<FilledOrgan>& organs) {
  std::vector<scenes::PlaceFinder::Organ> named;
  for (std::size_t i = 0; i < organs.size(); ++i)
    named.push_back({scene.organs[i].name, organs[i].centre.empty() ? nullptr : &organs[i].surface});
  return scenes::PlaceFinder(std::move(named), scene.gravity);
}

/// The mesh of an obstacle; empty for one of another kind, and where it cannot be read.
scenes::ObstacleMesh mesh_of(const std::string& scene_path, const scenes::ObstacleSpec& obstacle, std::size_t index,
                             scenes::Problems& problems) {
  const std::string at = "/obstacles/" + std::to_string(index);
  if (obstacle.mesh.empty() || !problems.are_good(at, {"mesh", "mesh_unit"})) return {};
  Result<importers::CheckedMesh> mesh =
      importers::import_mesh(scenes::mesh_path(scene_path, obstacle.mesh), scenes::metres_of(obstacle.mesh_unit));
  if (mesh) return {std::move(mesh->vertex), std::move(mesh->triangle)};
  add_mesh_errors(problems, "/obstacles", index, mesh.errors());
  return {};
}

/// The progress of one organ of `count` within that of all.
importers::Progress progress_of(const importers::Progress& all, std::size_t organ, std::size_t count) {
  if (!all) return {};
  return [&all, organ, count](const std::string& stage, double fraction) {
    all(stage, (double(organ) + fraction) / double(count));
  };
}

}  // namespace

void move_organ(FilledOrgan& organ, Vec3 by) {
  for (auto* places : {&organ.centre, &organ.surface.vertex})
    for (Vec3& place : *places) place = place + by;
}

Result<importers::ImportedOrgan> fill_of(const std::string& scene_path, const scenes::OrganSpec& organ,
                                         const std::function<bool()>& should_stop, Vec3 lattice_shift,
                                         const importers::Progress& progress) {
  if (!organ.rig) {
    importers::ImportOptions options = import_options_of(organ);
    options.lattice_shift = lattice_shift;
    options.should_stop = should_stop, options.progress = progress;
    Result<importers::ImportedOrgan> filled =
        importers::import_organ(scenes::mesh_path(scene_path, organ.mesh), options);
    if (filled) move(*filled, organ.at);
    return filled;
  }
  // A rig has no mesh; its surface is empty and bound to nothing.
  importers::ImportedOrgan filled;
  filled.organ = scenes::fill_rig(organ);
  filled.organ.surface.binding.first = {0};
  return filled;
}

Result<LoadedScene> load_whole_scene(const std::string& path, const scenes::LoadOptions& options,
                                     const std::function<void(scenes::SceneSpec&)>& change,
                                     const std::function<bool()>& should_stop, const importers::Progress& progress) {
  Result<scenes::SceneDraft> draft = scenes::load_draft(path, options);
  if (!draft) return draft.errors();
  if (change && draft->problems.is_empty()) change(draft->scene.spec);
  LoadedScene loaded;
  loaded.path = path;
  std::vector<Errors> mesh_errors;
  for (std::size_t i = 0; i < draft->scene.spec.organs.size(); ++i) {
    importers::ImportedOrgan filled;
    mesh_errors.emplace_back();
    if (scenes::can_be_filled(draft->problems, i)) {
      Result<importers::ImportedOrgan> imported = fill_of(path, draft->scene.spec.organs[i], should_stop, {},
                                                          progress_of(progress, i, draft->scene.spec.organs.size()));
      if (imported)
        filled = *std::move(imported);
      else
        mesh_errors.back() = imported.errors();
    }
    loaded.organs.push_back(std::move(filled.organ));
    loaded.reports.push_back(std::move(filled.report));
  }
  if (!draft->open_places.empty()) {
    // Read again, now that there are organs to find places on.
    scenes::PlaceFinder finder = finder_on(draft->scene.spec, loaded.organs);
    draft = scenes::load_draft(path, options, &finder);
    if (!draft) return draft.errors();
    if (change && draft->problems.is_empty()) change(draft->scene.spec);
  }
  scenes::SceneText& scene = draft->scene;
  scenes::Problems& problems = draft->problems;
  for (std::size_t i = 0; i < mesh_errors.size(); ++i) add_mesh_errors(problems, "/organs", i, mesh_errors[i]);
  for (std::size_t i = 0; i < scene.spec.obstacles.size(); ++i)
    loaded.obstacles.push_back(mesh_of(path, scene.spec.obstacles[i], i, problems));
  if (should_stop && should_stop()) return Error{path, "stopped", ""};
  std::optional<scenes::BuiltScene> built = scenes::build_model(scene.spec, loaded.organs, problems, loaded.obstacles);
  if (!built) return problems.errors();
  loaded.built = *std::move(built);
  loaded.scene = std::move(scene);
  return loaded;
}

Result<scenes::BuiltScene> build_changed(const LoadedScene& scene,
                                         const std::function<void(scenes::SceneSpec&)>& change) {
  scenes::SceneSpec spec = scene.scene.spec;
  change(spec);
  return scenes::build_model(spec, scene.organs, scene.obstacles);
}

double damage_force_of(const scenes::SceneSpec& scene) {
  double least = 0;
  for (const scenes::OrganSpec& organ : scene.organs)
    if (organ.damage_force > 0 && (least == 0 || organ.damage_force < least)) least = organ.damage_force;
  return least;
}

}  // namespace ctpm::loading
