#include "scenes/scene_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "scenes/field_reader.h"
#include "scenes/field_writer.h"
#include "scenes/presets.h"
#include "scenes/scene_fields.h"

namespace ctpm {
namespace {

namespace fs = std::filesystem;

bool is_whole(Vec3 v) { return std::floor(v.x) == v.x && std::floor(v.y) == v.y && std::floor(v.z) == v.z; }

std::string item(const char* list, std::size_t index) { return std::string("/") + list + "/" + std::to_string(index); }

/// Names within one list must differ.
template <class T>
void check_names(Problems& problems, const char* list, const std::vector<T>& items) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (!items[i].name.empty() && !seen.insert(items[i].name).second)
      problems.add_rule(item(list, i) + "/name", "got " + in_quotes(items[i].name) + ", which is taken already");
}

void check_material(Problems& problems, const std::string& at, const MaterialSpec& spec, Structure structure) {
  if (!spec.preset.empty() && find_preset(spec.preset) == nullptr) {
    const std::string nearest = nearest_word(spec.preset, preset_names());
    std::string known;
    for (const std::string& name : preset_names()) known += (known.empty() ? "" : ", ") + name;
    problems.add_rule(at + "/preset", "there is no preset " + in_quotes(spec.preset),
                      nearest.empty() ? "presets: " + known : "did you mean " + in_quotes(nearest) + "?");
    return;
  }
  const ResolvedMaterial resolved = resolve_material(spec);
  for (const std::string& key : resolved.missing)
    problems.add_rule(at, "the key " + in_quotes(key) + " is missing, and there is no preset to take it from");
  const Material& m = resolved.material;
  const double p2 = m.spring > 0 && m.kelvin > 0 ? m.kelvin * m.spring / (m.kelvin + m.spring) : 0;
  if (resolved.missing.empty() && structure == Structure::ctpm && m.constraint < p2)
    problems.add_rule(at + "/constraint_kpa_per_mm", "got " + double_to_decimal(m.constraint, 6) +
                                                         " kPa/mm, must be at least K1 K2 / (K1 + K2) = " +
                                                         double_to_decimal(p2, 6) + ", which the triples already give");
}

void check_layers(Problems& problems, const std::string& at, const OrganSpec& organ) {
  for (std::size_t i = 0; i < organ.layers.size(); ++i) {
    const std::string where = at + "/layers/" + std::to_string(i);
    check_material(problems, where + "/material", organ.layers[i].material, organ.model);
    if (i > 0 && !(organ.layers[i].to_depth > organ.layers[i - 1].to_depth))
      problems.add_rule(where + "/to_depth_mm",
                        "got " + double_to_decimal(organ.layers[i].to_depth, -3) + ", must be more than the " +
                            double_to_decimal(organ.layers[i - 1].to_depth, -3) + " mm at which the layer above ends");
  }
}

void check_rig(Problems& problems, const std::string& at, const RigSpec& rig) {
  if (rig.cells.empty() == !rig.block) problems.add_rule(at + "/rig", "must have exactly one of cells, block");
  const char* too_few = "got one sphere, a rig needs at least two that are neighbours";
  std::set<std::array<double, 3>> cells;
  for (std::size_t i = 0; i < rig.cells.size(); ++i) {
    const Vec3 cell = rig.cells[i];
    const std::string where = at + "/rig/cells/" + std::to_string(i);
    if (!is_whole(cell)) problems.add_rule(where, "must be whole numbers");
    if (!cells.insert({cell.x, cell.y, cell.z}).second) problems.add_rule(where, "the cell is given more than once");
  }
  if (rig.cells.size() == 1) problems.add_rule(at + "/rig/cells", too_few);
  if (rig.block && !is_whole(*rig.block)) problems.add_rule(at + "/rig/block", "must be whole numbers");
  if (rig.block == Vec3{1, 1, 1}) problems.add_rule(at + "/rig/block", too_few);
  const auto is_cell = [&](Vec3 cell) {
    if (!rig.block) return cells.contains({cell.x, cell.y, cell.z});
    const auto is_in = [](double i, double count) { return i >= 0 && i < count; };
    return is_whole(cell) && is_in(cell.x, rig.block->x) && is_in(cell.y, rig.block->y) && is_in(cell.z, rig.block->z);
  };
  for (std::size_t i = 0; i < rig.guides.size(); ++i) {
    const GuideSpec& guide = rig.guides[i];
    const std::string where = at + "/rig/guides/" + std::to_string(i);
    if (guide.axes.find_first_not_of("xyz") != std::string::npos || guide.axes.size() > 3)
      problems.add_rule(where + "/axes", "got " + in_quotes(guide.axes) + ", must be letters of xyz");
    if (!is_cell(guide.cell)) problems.add_rule(where + "/cell", "is not one of the rig's cells");
  }
}

void check_organ(Problems& problems, std::size_t index, const OrganSpec& organ) {
  const std::string at = item("organs", index);
  if (organ.mesh.empty() == !organ.rig) problems.add_rule(at, "must have exactly one of mesh, rig");
  if (organ.rig) check_rig(problems, at, *organ.rig);
  check_material(problems, at + "/material", organ.material, organ.model);
  check_layers(problems, at, organ);
  for (std::size_t i = 0; i < organ.anchors.size(); ++i) {
    const AnchorSpec& anchor = organ.anchors[i];
    const std::string where = at + "/anchors/" + std::to_string(i);
    if (anchor.plane) check_direction(problems, where + "/plane/normal", anchor.plane->normal);
    if (anchor.box && !(anchor.box->min.x <= anchor.box->max.x && anchor.box->min.y <= anchor.box->max.y &&
                        anchor.box->min.z <= anchor.box->max.z))
      problems.add_rule(where + "/box", "min_mm must not be above max_mm in any coordinate");
  }
  if (organ.lattice == LatticeKind::cubic_6 && organ.model != Structure::angle_mass_spring && !organ.mesh.empty())
    problems.add_warning(at + "/lattice",
                         "cubic-6 has elements along the axes only and no shear stiffness at all: the organ "
                         "will fold up under a probe",
                         "use cubic-18, or the model angle-mass-spring");
}

void check_tool(Problems& problems, std::size_t index, const ToolSpec& tool) {
  const std::string at = item("tools", index);
  const auto allow = [&](bool is_given, ToolKind kind, const char* key, const char* kind_name) {
    if (tool.kind != kind && is_given)
      problems.add_rule(at + "/" + key, std::string("only a ") + kind_name + " has this key");
  };
  const auto need = [&](bool is_given, ToolKind kind, const char* key, const char* kind_name) {
    if (tool.kind == kind && !is_given)
      problems.add_rule(at, std::string("a ") + kind_name + " needs the key " + in_quotes(key));
    allow(is_given, kind, key, kind_name);
  };
  need(tool.radius.has_value(), ToolKind::ball, "radius_mm", "ball");
  need(tool.blade_length.has_value(), ToolKind::scalpel, "blade_length_mm", "scalpel");
  need(tool.holds.has_value(), ToolKind::pin, "holds_mm", "pin");
  allow(tool.blade_reach.has_value(), ToolKind::scalpel, "blade_reach_mm", "scalpel");
  allow(tool.flank_height.has_value(), ToolKind::scalpel, "flank_height_mm", "scalpel");
  allow(tool.blade_thickness.has_value(), ToolKind::scalpel, "blade_thickness_mm", "scalpel");
}

void check_camera(Problems& problems, std::size_t index, const CameraSpec& camera) {
  const std::string at = item("cameras", index);
  if (camera.eye == camera.target) problems.add_rule(at + "/target_mm", "must not be the same point as eye_mm");
  check_direction(problems, at + "/up", camera.up);
  if (norm(camera.up) > 0 &&
      norm(cross(camera.up, camera.target - camera.eye)) < 1e-6 * norm(camera.up) * norm(camera.target - camera.eye))
    problems.add_rule(at + "/up", "must not point along the line of sight");
}

/// What only shows when values are read together.
void check_rules(Problems& problems, const SceneSpec& scene) {
  check_names(problems, "organs", scene.organs);
  check_names(problems, "tools", scene.tools);
  check_names(problems, "cameras", scene.cameras);
  check_names(problems, "probes", scene.probes);
  for (std::size_t i = 0; i < scene.organs.size(); ++i) check_organ(problems, i, scene.organs[i]);
  for (std::size_t i = 0; i < scene.tools.size(); ++i) check_tool(problems, i, scene.tools[i]);
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) check_camera(problems, i, scene.cameras[i]);
}

bool leaves_folder(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  return normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

/// Problems with the files that a scene names.
void check_files(Problems& problems, const SceneSpec& scene, const std::string& scene_path,
                 const LoadOptions& options) {
  for (std::size_t i = 0; i < scene.organs.size(); ++i) {
    if (scene.organs[i].mesh.empty()) continue;
    const std::string at = item("organs", i) + "/mesh", path = mesh_path(scene_path, scene.organs[i]);
    std::error_code ignored;
    if (leaves_folder(scene.organs[i].mesh) && !options.allow_outside_paths)
      problems.add_rule(at, "got " + in_quotes(scene.organs[i].mesh) + ", which leaves the scene's folder",
                        "put the mesh beside the scene, or allow it with --allow-outside-paths");
    else if (!fs::exists(path, ignored))
      problems.add_rule(at, "there is no file " + in_quotes(scene.organs[i].mesh) + " in the scene's folder",
                        "looked for " + path);
    else if (!fs::is_regular_file(path, ignored))
      problems.add_rule(at, in_quotes(scene.organs[i].mesh) + " is not a file");
  }
}

template <class CheckMore>
Result<SceneText> read_with(std::string_view text, const std::string& file_name, CheckMore&& check_more) {
  const Result<JsonNode> root = parse_json(text, file_name);
  if (!root) return root.errors();
  SceneText scene;
  scene.text = std::string(text);
  Problems problems(*root, file_name);
  FieldReader::read_record(*root, "", problems, scene.spec);
  check_rules(problems, scene.spec);
  check_more(problems, scene.spec);
  if (Errors errors = problems.errors(); !errors.empty()) return errors;
  scene.warnings = problems.warnings();
  return scene;
}

}  // namespace

Result<SceneText> read_scene(std::string_view text, const std::string& file_name) {
  return read_with(text, file_name, [](Problems&, const SceneSpec&) {});
}

Result<SceneText> load_scene(const std::string& path, const LoadOptions& options) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return Error{path, "does not exist", ""};
  if (!fs::is_regular_file(path, ignored)) return Error{path, "is not a file", ""};
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return Error{path, std::string("cannot be read: ") + std::strerror(errno), ""};
  return read_with(text.str(), path,
                   [&](Problems& problems, const SceneSpec& scene) { check_files(problems, scene, path, options); });
}

std::string mesh_path(const std::string& scene_path, const OrganSpec& organ) {
  return (fs::path(scene_path).parent_path() / organ.mesh).lexically_normal().string();
}

std::string write_scene(const SceneSpec& spec) {
  SceneSpec copy = spec;  // the table is written for reading as well and asks for what can be changed
  return FieldWriter::record_text(copy, 0) + "\n";
}

}  // namespace ctpm
