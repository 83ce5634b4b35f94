#include "studio/authoring/import_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scenes/anchors.h"
#include "scenes/presets.h"
#include "scenes/scene_file.h"
#include "scenes/script.h"
#include "studio/authoring/fit_stiffness.h"
#include "studio/output/files.h"
#include "studio/output/option_name.h"
#include "studio/render/scene_view.h"

namespace ctpm::authoring {
namespace {

namespace fs = std::filesystem;

/// Larger organs [spheres] are imported without a fit, which would take longer than a few seconds.
constexpr std::size_t kMostFittedSpheres = 4000;

/// The requested preset, or the one whose organ the mesh's file name contains.
Result<const scenes::MaterialPreset*> choose_preset(const ImportRequest& request) {
  std::string known;
  for (const scenes::MaterialPreset& preset : scenes::material_presets()) {
    if (request.organ == preset.name) return &preset;
    known += (known.empty() ? "" : ", ") + std::string(preset.name);
  }
  if (!request.organ.empty())
    return Error{output::option_name("import.organ"), "there is no preset '" + request.organ + "'",
                 "presets: " + known};
  const std::string name = fs::path(request.mesh).stem().string();
  for (const scenes::MaterialPreset& preset : scenes::material_presets())
    if (name.find(preset.organ) != std::string::npos) return &preset;
  return Error{output::option_name("import.organ"), "the file's name does not say which organ it is",
               "give one of " + known};
}

/// A camera that sees the organ from the front, a little from above.
scenes::CameraSpec front_camera(const FilledOrgan& organ) {
  Vec3 low = organ.surface.vertex.front(), high = low;
  for (const Vec3& p : organ.surface.vertex) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const auto whole_mm = [](Vec3 p) {
    return Vec3{std::round(p.x * 1e3) * 1e-3, std::round(p.y * 1e3) * 1e-3, std::round(p.z * 1e3) * 1e-3};
  };
  const double size = norm(high - low);
  scenes::CameraSpec camera;
  camera.name = "front";
  // The organ is right of the centre, clear of the panels on the left.
  camera.target = whole_mm(0.5 * (low + high) + size * Vec3{-0.13, 0, 0});
  camera.eye = whole_mm(camera.target + size * Vec3{0.05, -1.25, 0.95});
  camera.field_of_view = 32;
  return camera;
}

double extent_z(const FilledOrgan& organ) {
  const auto [low, high] =
      std::minmax_element(organ.centre.begin(), organ.centre.end(), [](Vec3 a, Vec3 b) { return a.z < b.z; });
  return high->z - low->z;
}

/// Height [m] above the lowest sphere that contains at least an eighth of all spheres. An organ anchored by fewer would
/// tip over while it settles.
double footing_height(const FilledOrgan& organ) {
  std::vector<double> heights;
  for (const Vec3& centre : organ.centre) heights.push_back(centre.z);
  std::sort(heights.begin(), heights.end());
  return std::ceil(1e3 * (heights[(heights.size() - 1) / 8] - heights.front()) + 0.5) / 1e3;
}

scenes::SceneSpec make_scene(const ImportRequest& request, const scenes::MaterialPreset& preset,
                             const FilledOrgan& organ, const std::string& name) {
  scenes::SceneSpec scene;
  scene.name = name;
  scenes::OrganSpec spec;
  spec.name = name;
  spec.mesh = name + ".obj";
  spec.all_parts = request.all_parts, spec.most_triangles = request.most_triangles;
  spec.fill.radius = organ.sphere_radius;
  spec.fill.gap = organ.spacing - 2 * organ.sphere_radius;
  spec.material.preset = preset.name;
  spec.damage_depth = preset.damage_depth;
  const render::OrganLook look = render::look_of(preset.organ);
  spec.surface_color = {look.outer[0], look.outer[1], look.outer[2]};
  spec.inner_color = {look.inner[0], look.inner[1], look.inner[2]};
  spec.anchors = request.anchors;
  if (spec.anchors.empty()) {
    scenes::AnchorSpec lowest;
    lowest.lowest = footing_height(organ);
    spec.anchors = {lowest};
  }
  scene.organs = {spec};
  // Tools in proportion to the organ: a ball of 2.5 sphere radii; a blade of 0.7 of the organ's height, at least 40 mm.
  scenes::ToolSpec ball, scalpel;
  ball.name = "ball", ball.kind = ToolKind::ball, ball.radius = 2.5 * organ.sphere_radius;
  scalpel.name = "scalpel", scalpel.kind = ToolKind::scalpel;
  scalpel.blade_length = std::ceil(1e2 * std::max(0.04, 0.7 * extent_z(organ))) * 1e-2;
  scene.tools = {ball, scalpel};
  scene.cameras = {front_camera(organ)};
  return scene;
}

/// Fits the organ's stiffness and stores it in the scene; an organ that cannot be fitted keeps the preset's moduli.
void fit_scene(scenes::SceneSpec& scene, const FilledOrgan& organ, const ImportRequest& request,
               ImportOutcome& outcome) {
  if (organ.centre.size() > kMostFittedSpheres) {
    outcome.fit_problem = "with " + std::to_string(organ.centre.size()) + " spheres it takes long";
    outcome.can_be_fitted_later = true;
    return;
  }
  const Result<StiffnessFit> fit = fit_stiffness(scene, 0, organ, request.should_stop);
  if (!fit) {
    outcome.fit_problem = fit.errors().front().message;
    return;
  }
  apply_fit(scene.organs[0], *fit);
  outcome.stiffness_scale = fit->scale;
}

}  // namespace

Result<ImportOutcome> import_scene(const ImportRequest& request) {
  const Result<const scenes::MaterialPreset*> preset = choose_preset(request);
  if (!preset) return preset.errors();
  if (fs::path(request.scene).extension() != ".json")
    return Error{request.scene, "a scene's name must end in .json", ""};
  const fs::path folder = fs::path(request.scene).parent_path();
  const std::string name = fs::path(request.scene).stem().string();
  ImportOutcome outcome;
  outcome.scene_file = request.scene;
  outcome.mesh_file = (folder / (name + ".obj")).string();
  outcome.script_file = (folder / (name + ".script.json")).string();
  Errors errors;
  for (const std::string& file : {outcome.scene_file, outcome.mesh_file, outcome.script_file})
    if (const Result<Done> is_new = output::check_new(file, request.overwrite); !is_new)
      errors.insert(errors.end(), is_new.errors().begin(), is_new.errors().end());
  std::error_code ignored;
  if (fs::equivalent(outcome.mesh_file, request.mesh, ignored))
    return Error{outcome.mesh_file, "the repaired mesh would replace the mesh that is imported",
                 "give the scene another name or folder"};
  if (!errors.empty()) return errors;

  importers::ImportOptions options;
  options.unit_in_metres = request.unit_in_metres;
  options.usual_size = {(*preset)->usual_size_least, (*preset)->usual_size_most};
  options.part = request.part, options.all_parts = request.all_parts;
  options.sphere_radius = request.sphere_radius.value_or((*preset)->sphere_radius);
  options.gap = request.gap.value_or(-1);
  options.largest_hole = request.largest_hole;
  options.most_triangles = request.most_triangles.value_or(0);
  options.progress = request.progress, options.should_stop = request.should_stop;
  Result<importers::ImportedOrgan> imported = importers::import_organ(request.mesh, options);
  if (!imported) return imported.errors();
  outcome.report = imported->report;

  const std::vector<FilledOrgan> organs{std::move(imported->organ)};
  scenes::SceneSpec scene = make_scene(request, **preset, organs.front(), name);
  const Result<std::vector<std::int32_t>> anchored =
      scenes::select_anchored(organs.front(), scene.organs[0].anchors, scene.gravity, request.mesh);
  if (!anchored) return anchored.errors();
  outcome.anchored = anchored->size();
  fit_scene(scene, organs.front(), request, outcome);
  if (request.should_stop && request.should_stop()) return Error{request.mesh, "stopped", "nothing was written"};
  const importers::CheckedMesh& mesh = imported->mesh;
  if (const Result<Done> written = importers::write_obj(outcome.mesh_file, mesh.vertex, mesh.triangle); !written)
    return written.errors();
  const scenes::Script script = scenes::default_script(scene, organs);
  if (const Result<Done> written = output::write_text_file(outcome.script_file, scenes::write_script(script)); !written)
    return written.errors();
  if (const Result<Done> written = output::write_text_file(request.scene, scenes::write_scene(scene)); !written)
    return written.errors();
  return outcome;
}

}  // namespace ctpm::authoring
