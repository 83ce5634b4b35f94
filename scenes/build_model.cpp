#include "scenes/build_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/cutting/extent.h"
#include "core/network/network.h"
#include "core/stepping/integrator.h"
#include "core/surface/body_overlaps.h"
#include "core/surface/surface.h"
#include "scenes/anchors.h"
#include "scenes/json_text.h"
#include "scenes/presets.h"

namespace ctpm::scenes {
namespace {

/// Of an organ from a mesh, unless the scene says otherwise (our choice: presses, strokes and jumping tools left no
/// cell inside out).
constexpr double kInversionResistance = 10;

/// A tool is so much stiffer than the stiffest edge of the tissue, unless the scene says otherwise.
constexpr double kContactOverEdge = 20;

/// Of the heaviest sphere: lighter ones stand for less than half a cell of tissue and are no place to hold it.
constexpr double kHalfFull = 0.5;

std::vector<network::OrganSettings::Guide> guides_of(const OrganSpec& spec, const FilledOrgan& organ) {
  std::vector<network::OrganSettings::Guide> guides;
  if (!spec.rig) return guides;
  for (const GuideSpec& guide : spec.rig->guides) {
    const std::array<std::int32_t, 3> cell{std::int32_t(guide.cell.x), std::int32_t(guide.cell.y),
                                           std::int32_t(guide.cell.z)};
    const auto it = std::find(organ.cell.begin(), organ.cell.end(), cell);
    std::uint8_t axes = 0;
    for (const char axis : guide.axes) axes = std::uint8_t(axes | (1u << (axis - 'x')));
    if (it != organ.cell.end()) guides.push_back({std::int32_t(it - organ.cell.begin()), axes});
  }
  return guides;
}

std::string in_millimetres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g mm", length * 1e3);
  return text;
}

/// Materials of the layers. Reports each layer that holds no sphere, or ends deeper than the deepest sphere.
std::vector<network::LayerMaterial> layers_of(const OrganSpec& spec, const FilledOrgan& organ, const std::string& at,
                                              Problems& problems) {
  std::vector<network::LayerMaterial> layers;
  if (spec.layers.empty()) return layers;
  const auto [least, most] = std::minmax_element(organ.depth.begin(), organ.depth.end());
  const std::string depths =
      "its spheres lie " + in_millimetres(*least) + " to " + in_millimetres(*most) + " below its surface";
  double begin = 0;
  bool knows_begin = true;
  for (std::size_t i = 0; i < spec.layers.size(); ++i) {
    const double end = spec.layers[i].to_depth;
    const std::string where = at + "/layers/" + std::to_string(i) + "/to_depth_mm";
    const bool knows_end = problems.is_good(where);
    const bool holds_any = std::any_of(organ.depth.begin(), organ.depth.end(),
                                       [&](double depth) { return depth >= begin && depth < end; });
    if (end > *most)
      problems.add_rule(where, "got " + in_millimetres(end) + ", which is deeper than the organ", depths);
    else if (knows_begin && !holds_any)
      problems.add_rule(
          where, "the layer from " + in_millimetres(begin) + " to " + in_millimetres(end) + " holds no sphere", depths);
    layers.push_back({end, resolve_material(spec.layers[i].material).material});
    begin = end, knows_begin = knows_end;
  }
  return layers;
}

/// Spheres that the anchors hold. Reports each anchor that holds none.
std::vector<std::int32_t> anchored_in(const FilledOrgan& organ, const std::vector<AnchorSpec>& anchors, Vec3 gravity,
                                      const std::string& at, Problems& problems) {
  const Result<std::vector<std::int32_t>> anchored = select_anchored(organ, anchors, gravity, at);
  if (anchored) return *anchored;
  for (const Error& error : anchored.errors()) problems.add_rule(error.where, error.message, error.hint);
  return {};
}

/// Adds an organ's network to the Model. Reports what core refuses, and spheres of which no two are neighbours.
void add_network(Model& model, const FilledOrgan& organ, const network::OrganSettings& settings, bool is_rig,
                 const std::string& at, Problems& problems) {
  const std::size_t elements_before = model.element_count();
  if (const Result<Done> added = network::add_organ(model, organ, settings); !added) {
    for (const Error& error : added.errors())
      problems.add(at, error.where + ": " + error.message, error.hint, at + "/material");
    return;
  }
  if (model.element_count() > elements_before || !problems.is_good(at + "/lattice")) return;
  const std::string count = std::to_string(organ.centre.size());
  problems.add_rule(at + (is_rig ? "/rig/cells" : "/fill"),
                    "no two of the " + count + " spheres are neighbours, so nothing joins them",
                    is_rig ? "neighbours differ by 1 along one axis or two" : "take a smaller radius_mm");
}

/// Settings with which the neighbours of an organ's spheres can be found though some of its values are refused.
network::OrganSettings stand_in_for(const network::OrganSettings& refused) {
  network::OrganSettings settings;
  settings.name = refused.name, settings.structure = network::Structure::mass_spring,
  settings.lattice = refused.lattice;
  settings.material = find_preset("liver")->material;
  return settings;
}

/// Adds organ `index` of the scene to the Model. Reports its errors. False if the Model lacks the organ, or has a
/// stand-in for it, because some value is refused.
bool add_scene_organ(BuiltScene& built, const SceneSpec& scene, std::size_t index, const FilledOrgan& organ,
                     Problems& problems) {
  const OrganSpec& spec = scene.organs[index];
  const std::string at = "/organs/" + std::to_string(index);
  if (organ.centre.empty()) {
    if (can_be_filled(problems, index))
      problems.add_rule(at + (spec.rig ? "/rig" : "/mesh"), "the organ has no spheres", "take a smaller radius_mm");
    return false;
  }
  network::OrganSettings settings;
  settings.name = spec.name, settings.structure = spec.structure, settings.lattice = spec.lattice;
  const bool shares_by_three =
      spec.tiling == TilingSpec::automatic ? spec.rig.has_value() : spec.tiling == TilingSpec::three_spheres;
  settings.tiling = shares_by_three ? network::Tiling::three_spheres : network::Tiling::two_spheres;
  settings.has_softening = spec.softening, settings.material = resolve_material(spec.material).material;
  settings.damage_depth = spec.damage_depth, settings.guides = guides_of(spec, organ);
  settings.inversion_resistance = inversion_resistance_of(spec);
  settings.layers = layers_of(spec, organ, at, problems);
  settings.anchored = anchored_in(organ, spec.anchors, scene.gravity, at, problems);
  built.anchored_count.push_back(std::int32_t(settings.anchored.size()));
  const auto is_good = [&] {
    return can_be_filled(problems, index) && problems.are_good(at, {"rig", "model", "lattice", "softening", "material",
                                                                    "layers", "anchors", "inversion_resistance"});
  };
  add_network(built.model, organ, is_good() ? settings : stand_in_for(settings), spec.rig.has_value(), at, problems);
  if (is_good() && !built.model.organs.empty()) built.model.organs.back().meets_itself = spec.meets_itself;
  return is_good();
}

void set_solver(Model& model, const SolverSpec& solver) {
  const SolverSettings standard;
  model.solver.tolerance = solver.tolerance.value_or(standard.tolerance);
  model.solver.velocity_floor = solver.velocity_floor.value_or(standard.velocity_floor);
  // Our choice: a press of stiff tissue needs a third fewer iterations, and its force changes by less than half a
  // percent of the greatest.
  constexpr double kEnough = 2e-6;  // [m/s]
  model.solver.velocity_enough = solver.velocity_enough.value_or(solver.velocity_floor ? 0 : kEnough);
  model.solver.max_iterations = solver.max_iterations.value_or(standard.max_iterations);
  model.solver.substeps = solver.substeps.value_or(standard.substeps);
  model.solver.sleep_bound = solver.sleep_below.value_or(standard.sleep_bound);
}

/// Elements at the surface stand for little tissue and are softer than the tissue is.
double median_spring(const Model& model) {
  std::vector<double> k = model.axial.k;
  if (k.empty()) return 0;
  std::nth_element(k.begin(), k.begin() + std::ptrdiff_t(k.size() / 2), k.end());
  return k[k.size() / 2];
}

/// What only a blade needs.
void add_cutting(Model& model, const SceneSpec& scene) {
  const bool cuts = std::any_of(scene.tools.begin(), scene.tools.end(),
                                [](const ToolSpec& t) { return t.kind == ToolKind::scalpel; });
  if (!cuts)
    model.cut_resistance = {};
  else if (scene.lips_meet)
    model.lip_k = median_spring(model),
    model.cut_face_stiffening = scene.cut_face_stiffening.value_or(model.cut_face_stiffening);
}

double stiffest_spring(const Model& model) {
  double k = 0;
  for (const double spring : model.axial.k) k = std::max(k, spring);
  return k;
}

/// About that of a surgical blade No. 10 [m]. Tool's own default is that of sessions that do not store it.
constexpr double kBladeThickness = 0.4e-3;

void add_tools(Model& model, const SceneSpec& scene) {
  for (const ToolSpec& spec : scene.tools) {
    Tool tool;
    tool.name = spec.name, tool.kind = spec.kind;
    tool.radius = spec.radius.value_or(0), tool.blade_length = spec.blade_length.value_or(0);
    tool.blade_reach = spec.blade_reach.value_or(tool.blade_reach);
    tool.flank_height = spec.flank_height.value_or(tool.flank_height);
    tool.blade_thickness = spec.blade_thickness.value_or(kBladeThickness);
    if (spec.holds) tool.sphere = nearest_sphere(model, *spec.holds);
    model.tools.push_back(tool);
  }
  const bool presses =
      std::any_of(scene.tools.begin(), scene.tools.end(), [](const ToolSpec& t) { return t.kind == ToolKind::ball; });
  if (!presses && !model.has_meeting_bodies()) return;
  model.contact_k = scene.contact_stiffness.value_or(kContactOverEdge * stiffest_spring(model));
  model.contact_friction = scene.contact_friction;
  model.contact_damping = scene.contact_damping.value_or(model.contact_damping);
}

/// The turn that takes the z axis to `normal`, of any length but zero.
Quat turn_to(Vec3 normal) {
  const Vec3 n = normal / norm(normal);
  if (n.z <= -1 + 1e-12) return {0, 1, 0, 0};
  const double w = std::sqrt(0.5 * (1 + n.z));
  return {w, -0.5 * n.y / w, 0.5 * n.x / w, 0};
}

void add_obstacles(Model& model, const SceneSpec& scene, std::span<const ObstacleMesh> meshes, Problems& problems) {
  model.organs_meet = scene.organs_meet, model.hands = scene.hands.value_or(1);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const ObstacleSpec& spec = scene.obstacles[i];
    Obstacle obstacle;
    obstacle.name = spec.name;
    if (spec.plane) obstacle.position = spec.plane->point, obstacle.world_from_obstacle = turn_to(spec.plane->normal);
    if (spec.box) {
      obstacle.kind = ObstacleKind::box;
      obstacle.position = 0.5 * (spec.box->min + spec.box->max);
      obstacle.half_size = 0.5 * (spec.box->max - spec.box->min);
    }
    if (!spec.mesh.empty()) {
      obstacle.kind = ObstacleKind::mesh;
      const std::string at = "/obstacles/" + std::to_string(i) + "/mesh";
      if (i >= meshes.size() || meshes[i].triangle.empty()) {
        if (problems.is_good(at)) problems.add_rule(at, "was not read", "");
        continue;
      }
      for (const Vec3& v : meshes[i].vertex) obstacle.vertex.push_back(v);
      for (const auto& t : meshes[i].triangle) obstacle.corner.insert(obstacle.corner.end(), t.begin(), t.end());
    }
    model.obstacles.push_back(std::move(obstacle));
  }
}

/// Organs that meet push each other apart from the first tick on where the scene has them overlap.
void warn_of_overlap(const Model& model, Problems& problems) {
  if (!model.has_meeting_tissue()) return;
  constexpr double kTouching = 0.5e-3;  // [m]; meshes that lie against each other overlap a little
  const auto deepest = surface::deepest_overlap(model, model.rest_position);
  if (!deepest || deepest->depth < kTouching) return;
  char place[96];
  std::snprintf(place, sizeof place, "(%.4g, %.4g, %.4g) mm", 1e3 * deepest->place.x, 1e3 * deepest->place.y,
                1e3 * deepest->place.z);
  const std::string name = model.organs[std::size_t(deepest->organ)].name,
                    other = model.organs[std::size_t(deepest->other)].name;
  problems.add_warning("/organs/" + std::to_string(deepest->organ),
                       "the surfaces of " + in_quotes(name) + " and " + in_quotes(other) + " overlap by " +
                           in_millimetres(deepest->depth) + " or more at " + place + "; they push each other apart",
                       "move them apart, or leave out organs_meet");
}

/// What the scene asks for; none: core chooses.
std::optional<Integrator> integrator_of(IntegratorSpec spec) {
  switch (spec) {
    case IntegratorSpec::automatic:
      break;
    case IntegratorSpec::leapfrog:
      return Integrator::leapfrog;
    case IntegratorSpec::backward_euler:
      return Integrator::backward_euler;
    case IntegratorSpec::sdirk2:
      return Integrator::sdirk2;
  }
  return std::nullopt;
}

}  // namespace

double inversion_resistance_of(const OrganSpec& organ) {
  return organ.inversion_resistance.value_or(organ.rig ? 0.0 : kInversionResistance);
}

FilledOrgan fill_rig(const OrganSpec& organ) {
  FilledOrgan filled;
  filled.sphere_radius = organ.fill.radius;
  filled.spacing = organ.fill.spacing();
  Vec3 origin;
  std::vector<Vec3> cells = organ.rig->cells;
  if (organ.rig->block) {
    const Vec3 n = *organ.rig->block;
    origin = -0.5 * filled.spacing * Vec3{n.x - 1, n.y - 1, 0};
    for (double k = 0; k < n.z; ++k)
      for (double j = 0; j < n.y; ++j)
        for (double i = 0; i < n.x; ++i) cells.push_back({i, j, k});
  }
  std::sort(cells.begin(), cells.end(), [](Vec3 a, Vec3 b) {
    return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  for (const Vec3& c : cells) {
    filled.cell.push_back({std::int32_t(c.x), std::int32_t(c.y), std::int32_t(c.z)});
    filled.centre.push_back(origin + filled.spacing * c);
    // Layers of a block count inwards from its faces; the few spheres of a rig are all outermost.
    std::int32_t rim = 0;
    if (organ.rig->block) {
      const Vec3 n = *organ.rig->block;
      rim = std::int32_t(std::min({c.x, n.x - 1 - c.x, c.y, n.y - 1 - c.y, c.z, n.z - 1 - c.z}));
    }
    filled.layer.push_back(1 + rim);
    filled.depth.push_back((0.5 + rim) * filled.spacing);
  }
  return filled;
}

std::int32_t nearest_sphere(const Model& model, Vec3 point) {
  std::int32_t nearest = -1;
  double least = INFINITY;
  for (const OrganRange& organ : model.organs) {
    const auto first = std::size_t(organ.first), last = first + std::size_t(organ.count);
    const double heaviest =
        *std::max_element(model.mass.begin() + organ.first, model.mass.begin() + organ.first + organ.count);
    for (std::size_t i = first; i < last; ++i) {
      const Vec3 apart = model.rest_position[i] - point;
      if (model.mass[i] < kHalfFull * heaviest || dot(apart, apart) >= least) continue;
      least = dot(apart, apart), nearest = std::int32_t(i);
    }
  }
  return nearest;
}

namespace {

/// Adds a load at a point of the tissue: in an organ with a surface, to the spheres around it as a surface there would.
void add_load(Model& model, const LoadSpec& load) {
  const std::int32_t nearest = nearest_sphere(model, load.at);
  std::vector<std::int32_t> spheres{nearest};
  std::vector<double> weights{1};
  for (std::size_t o = 0; o < model.organs.size(); ++o) {
    const OrganRange& organ = model.organs[o];
    if (nearest < organ.first || nearest >= organ.first + organ.count || model.surfaces[o].triangle.empty()) continue;
    const double reach = surface::kBindingReach * organ.spacing;
    std::vector<Vec3> centres;
    std::vector<double> trust;
    std::vector<std::int32_t> around;
    for (std::int32_t i = organ.first; i < organ.first + organ.count; ++i)
      if (const Vec3 centre = model.rest_position[std::size_t(i)]; norm(centre - load.at) < reach)
        around.push_back(i), centres.push_back(centre), trust.push_back(model.mass[std::size_t(i)]);
    if (around.size() < 4) continue;
    spheres = around, weights = surface::follow_weights(load.at, centres, trust, reach);
  }
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    model.loads.sphere.push_back(spheres[i]);
    model.loads.force.push_back(weights[i] * load.force);
    model.loads.start.push_back(load.start), model.loads.ramp.push_back(load.ramp);
  }
}

}  // namespace

bool can_be_filled(const Problems& problems, std::size_t index) {
  const std::string at = "/organs/" + std::to_string(index);
  return problems.are_good(at, {"mesh", "mesh_unit", "turn_deg", "scale", "all_parts", "most_triangles", "fill"}) &&
         problems.are_good(at + "/rig", {"cells", "block"});
}

std::optional<BuiltScene> build_model(const SceneSpec& scene, std::span<const FilledOrgan> organs, Problems& problems,
                                      std::span<const ObstacleMesh> meshes) {
  CTPM_CHECK(organs.size() == scene.organs.size(), "one filled organ for each organ of the scene");
  BuiltScene built;
  Model& model = built.model;
  model.tick = scene.tick;
  model.gravity = scene.gravity;
  bool has_all_organs = true;
  for (std::size_t i = 0; i < organs.size(); ++i)
    has_all_organs = add_scene_organ(built, scene, i, organs[i], problems) && has_all_organs;
  if (!has_all_organs) return std::nullopt;
  if (const std::string problem = cutting::extent_problem(organs); !problem.empty())
    problems.add_rule("/organs", problem, "make them smaller with `scale`, or lay them closer together with `at_mm`");
  add_obstacles(model, scene, meshes, problems);
  add_tools(model, scene);
  add_cutting(model, scene);
  for (const LoadSpec& load : scene.loads) add_load(model, load);
  for (const ProbeSpec& probe : scene.probes) built.probe_sphere.push_back(nearest_sphere(model, probe.at));
  set_solver(model, scene.solver);
  if (problems.are_good("", {"tick_s", "solver"})) {
    const stepping::IntegratorChoice& choice = built.integrator =
        stepping::resolve_integrator(model, integrator_of(scene.solver.integrator));
    if (!choice.holds)
      problems.add_rule("/solver/integrator", std::string(stepping::name_of(choice.integrator)) + ": " + choice.reason,
                        "take `auto`, `backward-euler`, or more substeps");
  }
  if (!problems.is_empty()) return std::nullopt;
  warn_of_overlap(model, problems);
  return built;
}

Result<BuiltScene> build_model(const SceneSpec& scene, std::span<const FilledOrgan> organs,
                               std::span<const ObstacleMesh> meshes) {
  Problems problems;
  std::optional<BuiltScene> built = build_model(scene, organs, problems, meshes);
  if (!built) return problems.errors();
  return *std::move(built);
}

}  // namespace ctpm::scenes
