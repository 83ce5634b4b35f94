#include "scenes/scene_rules.h"

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "scenes/field_reader.h"
#include "scenes/json_text.h"
#include "scenes/presets.h"

namespace ctpm::scenes {
namespace {

bool is_whole(Vec3 v) { return std::floor(v.x) == v.x && std::floor(v.y) == v.y && std::floor(v.z) == v.z; }

std::string item(const std::string& list, std::size_t index) { return list + "/" + std::to_string(index); }

/// Names within one list must differ.
template <class T>
void check_names(Problems& problems, const char* list, const std::vector<T>& items) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (!items[i].name.empty() && !seen.insert(items[i].name).second)
      problems.add_rule(item(list, i) + "/name", "got " + in_quotes(items[i].name) + ", which is taken already");
}

void check_preset(Problems& problems, const std::string& at, const std::string& preset) {
  if (preset.empty() || find_preset(preset) != nullptr) return;
  const std::string nearest = nearest_word(preset, preset_names());
  std::string known;
  for (const std::string& name : preset_names()) known += (known.empty() ? "" : ", ") + name;
  problems.add_rule(at + "/preset", "there is no preset " + in_quotes(preset),
                    nearest.empty() ? "presets: " + known : "did you mean " + in_quotes(nearest) + "?");
}

/// `organ` is the pointer of the material's organ. A structure that is refused is not judged.
void check_material_of(Problems& problems, const std::string& at, const MaterialSpec& spec, const std::string& organ,
                       network::Structure structure) {
  const bool is_known = problems.is_good(organ + "/model");
  check_material(problems, at, spec, is_known ? structure : network::Structure::tpm);
}

void check_layers(Problems& problems, const std::string& at, const OrganSpec& organ) {
  for (std::size_t i = 0; i < organ.layers.size(); ++i) {
    const std::string where = item(at + "/layers", i);
    check_material_of(problems, where + "/material", organ.layers[i].material, at, organ.structure);
    if (i == 0 || !problems.is_good(item(at + "/layers", i - 1) + "/to_depth_mm")) continue;
    if (!(organ.layers[i].to_depth > organ.layers[i - 1].to_depth))
      problems.add_rule(where + "/to_depth_mm",
                        "got " + double_to_decimal(organ.layers[i].to_depth, -3) + ", must be more than the " +
                            double_to_decimal(organ.layers[i - 1].to_depth, -3) + " mm at which the layer above ends");
  }
}

void check_guides(Problems& problems, const std::string& at, const RigSpec& rig,
                  const std::set<std::array<double, 3>>& cells) {
  const bool knows_cells = problems.are_good(at, {"cells", "block"});
  const auto is_cell = [&](Vec3 cell) {
    if (!rig.block) return cells.contains({cell.x, cell.y, cell.z});
    const auto is_in = [](double i, double count) { return i >= 0 && i < count; };
    return is_whole(cell) && is_in(cell.x, rig.block->x) && is_in(cell.y, rig.block->y) && is_in(cell.z, rig.block->z);
  };
  for (std::size_t i = 0; i < rig.guides.size(); ++i) {
    const GuideSpec& guide = rig.guides[i];
    const std::string where = item(at + "/guides", i);
    if (guide.axes.find_first_not_of("xyz") != std::string::npos || guide.axes.size() > 3)
      problems.add_rule(where + "/axes", "got " + in_quotes(guide.axes) + ", must be letters of xyz");
    if (knows_cells && !is_cell(guide.cell)) problems.add_rule(where + "/cell", "is not one of the rig's cells");
  }
}

void check_rig(Problems& problems, const std::string& at, const RigSpec& rig) {
  if (problems.are_good(at, {"cells", "block"}) && rig.cells.empty() == !rig.block)
    problems.add_rule(at, "must have exactly one of cells, block");
  const char* too_few = "got one sphere, a rig needs at least two that are neighbours";
  std::set<std::array<double, 3>> cells;
  for (std::size_t i = 0; i < rig.cells.size(); ++i) {
    const Vec3 cell = rig.cells[i];
    const std::string where = item(at + "/cells", i);
    if (!problems.is_good(where)) continue;
    if (!is_whole(cell)) problems.add_rule(where, "must be whole numbers");
    if (!cells.insert({cell.x, cell.y, cell.z}).second) problems.add_rule(where, "the cell is given more than once");
  }
  if (rig.cells.size() == 1) problems.add_rule(at + "/cells", too_few);
  if (rig.block && !is_whole(*rig.block)) problems.add_rule(at + "/block", "must be whole numbers");
  if (rig.block == Vec3{1, 1, 1}) problems.add_rule(at + "/block", too_few);
  check_guides(problems, at, rig, cells);
}

/// `region`: an anchor or an obstacle.
template <class Region>
void check_region(Problems& problems, const std::string& at, const Region& region) {
  if (region.plane) check_direction(problems, at + "/plane/normal", region.plane->normal);
  if (region.box && !(region.box->min.x <= region.box->max.x && region.box->min.y <= region.box->max.y &&
                      region.box->min.z <= region.box->max.z))
    problems.add_rule(at + "/box", "min_mm must not be above max_mm in any coordinate");
}

void check_obstacle(Problems& problems, std::size_t index, const ObstacleSpec& obstacle) {
  const std::string at = item("/obstacles", index);
  const int kinds = obstacle.plane.has_value() + obstacle.box.has_value() + !obstacle.mesh.empty();
  if (problems.are_good(at, {"plane", "box", "mesh"}) && kinds != 1)
    problems.add_rule(at, "must have exactly one of plane, box, mesh");
  check_region(problems, at, obstacle);
  if (!obstacle.box || !problems.is_good(at + "/box")) return;
  const Vec3 size = obstacle.box->max - obstacle.box->min;
  if (size.x == 0 || size.y == 0 || size.z == 0) problems.add_rule(at + "/box", "has no volume");
}

void check_zones(Problems& problems, const std::vector<ZoneSpec>& zones) {
  for (std::size_t i = 0; i < zones.size(); ++i) check_region(problems, item("/forbidden", i), zones[i]);
}

/// What touches what.
void check_meeting(Problems& problems, const SceneSpec& scene) {
  std::size_t meshes = 0;
  for (std::size_t i = 0; i < scene.organs.size(); ++i) {
    meshes += !scene.organs[i].rig;
    if (scene.organs[i].rig && scene.organs[i].meets_itself)
      problems.add_rule(item("/organs", i) + "/meets_itself", "a rig has no surface with which it could meet itself");
  }
  if (scene.organs_meet && meshes < 2 && problems.is_good("/organs"))
    problems.add_warning("/organs_meet", "only organs from meshes meet, and the scene has " + std::to_string(meshes));
}

void check_organ(Problems& problems, std::size_t index, const OrganSpec& organ) {
  const std::string at = item("/organs", index);
  if (problems.is_good(at + "/rig") && organ.mesh.empty() == !organ.rig)
    problems.add_rule(at, "must have exactly one of mesh, rig", "", at + "/mesh");
  if (organ.rig) check_rig(problems, at + "/rig", *organ.rig);
  const auto only_of_mesh = [&](bool is_given, const char* key) {
    if (organ.rig && is_given) problems.add_rule(at + "/" + key, "only an organ from a mesh has this key");
  };
  only_of_mesh(!(organ.at == Vec3{}), "at_mm"), only_of_mesh(!(organ.turn == Vec3{}), "turn_deg");
  only_of_mesh(organ.scale != 1, "scale");
  check_material_of(problems, at + "/material", organ.material, at, organ.structure);
  check_layers(problems, at, organ);
  for (std::size_t i = 0; i < organ.anchors.size(); ++i)
    check_region(problems, item(at + "/anchors", i), organ.anchors[i]);
  if (organ.lattice == network::LatticeKind::cubic_6 && organ.structure != network::Structure::angle_mass_spring &&
      !organ.mesh.empty())
    problems.add_warning(at + "/lattice",
                         "cubic-6 joins neighbours along the axes only and has no shear stiffness: the organ folds up "
                         "under a probe",
                         "use cubic-18, or the model angle-mass-spring");
}

/// Where a tool is taken up.
void check_tool_place(Problems& problems, const std::string& at, const ToolSpec& tool) {
  if (tool.kind == ToolKind::pin && tool.at) problems.add_rule(at + "/at_mm", "a pin is where it holds");
  if (!tool.at && tool.pointing) problems.add_rule(at + "/pointing", "has no meaning without at_mm");
  if (!tool.at && tool.facing) problems.add_rule(at + "/facing", "has no meaning without at_mm");
  if (tool.pointing) check_direction(problems, at + "/pointing", *tool.pointing);
  const Vec3 pointing = tool.pointing.value_or(Vec3{0, 0, -1});
  if (tool.facing && problems.are_good(at, {"pointing", "facing"}) &&
      norm(cross(*tool.facing, pointing)) <= 1e-6 * norm(*tool.facing) * norm(pointing))
    problems.add_rule(at + "/facing", "must not be zero or along pointing");
}

void check_tool(Problems& problems, std::size_t index, const ToolSpec& tool) {
  const std::string at = item("/tools", index);
  if (!problems.is_good(at + "/kind")) return;
  const auto allow = [&](bool is_given, ToolKind kind, const std::string& key, const std::string& kind_name) {
    if (tool.kind != kind && is_given) problems.add_rule(at + "/" + key, "only a " + kind_name + " has this key");
  };
  const auto need = [&](bool is_given, ToolKind kind, const std::string& key, const std::string& kind_name) {
    if (tool.kind == kind && !is_given)
      problems.add_rule(at, "a " + kind_name + " needs the key " + in_quotes(key), "", at + "/" + key);
    allow(is_given, kind, key, kind_name);
  };
  need(tool.radius.has_value(), ToolKind::ball, "radius_mm", "ball");
  need(tool.blade_length.has_value(), ToolKind::scalpel, "blade_length_mm", "scalpel");
  need(tool.holds.has_value(), ToolKind::pin, "holds_mm", "pin");
  allow(tool.blade_reach.has_value(), ToolKind::scalpel, "blade_reach_mm", "scalpel");
  allow(tool.flank_height.has_value(), ToolKind::scalpel, "flank_height_mm", "scalpel");
  allow(tool.blade_thickness.has_value(), ToolKind::scalpel, "blade_thickness_mm", "scalpel");
  check_tool_place(problems, at, tool);
}

void check_camera(Problems& problems, std::size_t index, const CameraSpec& camera) {
  const std::string at = item("/cameras", index);
  check_direction(problems, at + "/up", camera.up);
  if (!problems.are_good(at, {"eye_mm", "target_mm"})) return;
  if (camera.eye == camera.target) problems.add_rule(at + "/target_mm", "must not be the same point as eye_mm");
  if (norm(cross(camera.up, camera.target - camera.eye)) < 1e-6 * norm(camera.up) * norm(camera.target - camera.eye))
    problems.add_rule(at + "/up", "must not point along the line of sight");
}

}  // namespace

void check_material(Problems& problems, const std::string& at, const MaterialSpec& spec, network::Structure structure) {
  check_preset(problems, at, spec.preset);
  if (!problems.is_good(at + "/preset")) return;
  const ResolvedMaterial resolved = resolve_material(spec);
  for (const std::string& key : resolved.missing)
    problems.add_rule(at, "the key " + in_quotes(key) + " is missing, and there is no preset to take it from", "",
                      at + "/" + key);
  if (!problems.are_good(at, {"spring_kpa_per_mm", "kelvin_kpa_per_mm", "constraint_kpa_per_mm"}) ||
      structure != network::Structure::ctpm)
    return;
  const network::Material& m = resolved.material;
  const double p2 = m.kelvin * m.spring / (m.kelvin + m.spring);
  if (m.constraint < p2)
    problems.add_rule(at + "/constraint_kpa_per_mm", "got " + double_to_decimal(m.constraint, 6) +
                                                         " kPa/mm, must be at least K1 K2 / (K1 + K2) = " +
                                                         double_to_decimal(p2, 6) + ", which the triples already give");
}

void check_rules(Problems& problems, const SceneSpec& scene) {
  check_names(problems, "/organs", scene.organs);
  check_names(problems, "/tools", scene.tools);
  check_names(problems, "/cameras", scene.cameras);
  check_names(problems, "/probes", scene.probes);
  check_names(problems, "/obstacles", scene.obstacles);
  check_names(problems, "/forbidden", scene.forbidden);
  check_zones(problems, scene.forbidden);
  check_meeting(problems, scene);
  if (scene.hands == 2 && scene.tools.size() < 2 && problems.is_good("/tools"))
    problems.add_warning("/hands", "two hands need two tools, and the scene has " + std::to_string(scene.tools.size()));
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) check_obstacle(problems, i, scene.obstacles[i]);
  for (std::size_t i = 0; i < scene.organs.size(); ++i) check_organ(problems, i, scene.organs[i]);
  for (std::size_t i = 0; i < scene.tools.size(); ++i) check_tool(problems, i, scene.tools[i]);
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) check_camera(problems, i, scene.cameras[i]);
}

}  // namespace ctpm::scenes
