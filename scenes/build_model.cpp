#include "scenes/build_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/network/network.h"
#include "core/stepping/integrator.h"
#include "scenes/anchors.h"
#include "scenes/presets.h"

namespace ctpm {
namespace {

/// A tool is so much stiffer than the stiffest edge of the tissue, unless the scene says otherwise.
constexpr double kContactOverEdge = 20;

std::vector<OrganSettings::Guide> guides_of(const OrganSpec& spec, const FilledOrgan& organ) {
  std::vector<OrganSettings::Guide> guides;
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

/// The layers' materials. Adds an error for each layer that holds no sphere, or ends deeper than the deepest
/// sphere.
std::vector<LayerMaterial> layers_of(const OrganSpec& spec, const FilledOrgan& organ, const std::string& where,
                                     Errors& errors) {
  std::vector<LayerMaterial> layers;
  if (spec.layers.empty() || organ.depth.empty()) return layers;
  const auto [least, most] = std::minmax_element(organ.depth.begin(), organ.depth.end());
  const std::string depths =
      "its spheres lie " + in_millimetres(*least) + " to " + in_millimetres(*most) + " below its surface";
  double begin = 0;
  for (std::size_t i = 0; i < spec.layers.size(); ++i) {
    const double end = spec.layers[i].to_depth;
    const std::string at = where + "/layers/" + std::to_string(i) + "/to_depth_mm";
    const bool holds_any = std::any_of(organ.depth.begin(), organ.depth.end(),
                                       [&](double depth) { return depth >= begin && depth < end; });
    if (end > *most)
      errors.push_back({at, "got " + in_millimetres(end) + ", which is deeper than the organ", depths});
    else if (!holds_any)
      errors.push_back(
          {at, "the layer from " + in_millimetres(begin) + " to " + in_millimetres(end) + " holds no sphere", depths});
    layers.push_back({end, resolve_material(spec.layers[i].material).material});
    begin = end;
  }
  return layers;
}

double softest_spring(const Model& model) {
  double k = INFINITY;
  for (const double spring : model.axial.k) k = std::min(k, spring);
  return k;
}

/// What only a blade needs.
void add_cutting(Model& model, const SceneSpec& scene) {
  const bool cuts = std::any_of(scene.tools.begin(), scene.tools.end(),
                                [](const ToolSpec& t) { return t.kind == ToolKind::scalpel; });
  if (!cuts)
    model.cut_resistance = {};
  else if (scene.lips_meet)
    model.lip_k = softest_spring(model);
}

double stiffest_spring(const Model& model) {
  double k = 0;
  for (const double spring : model.axial.k) k = std::max(k, spring);
  return k;
}

void add_tools(Model& model, const SceneSpec& scene) {
  for (const ToolSpec& spec : scene.tools) {
    Tool tool;
    tool.name = spec.name, tool.kind = spec.kind;
    tool.radius = spec.radius.value_or(0), tool.blade_length = spec.blade_length.value_or(0);
    if (spec.holds) tool.sphere = nearest_sphere(model, *spec.holds);
    model.tools.push_back(tool);
  }
  const bool presses =
      std::any_of(scene.tools.begin(), scene.tools.end(), [](const ToolSpec& t) { return t.kind == ToolKind::ball; });
  if (!presses) return;
  model.contact_k = scene.contact_stiffness.value_or(kContactOverEdge * stiffest_spring(model));
  model.contact_friction = scene.contact_friction;
}

}  // namespace

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
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 apart = model.rest_position[i] - point;
    if (dot(apart, apart) < least) least = dot(apart, apart), nearest = std::int32_t(i);
  }
  return nearest;
}

Result<BuiltScene> build_model(const SceneSpec& scene, std::span<const FilledOrgan> organs) {
  CTPM_CHECK(organs.size() == scene.organs.size(), "one filled organ for each organ of the scene");
  BuiltScene built;
  Model& model = built.model;
  model.tick = scene.tick;
  model.gravity = scene.gravity;
  Errors errors;
  for (std::size_t i = 0; i < organs.size(); ++i) {
    const OrganSpec& spec = scene.organs[i];
    const std::string where = "/organs/" + std::to_string(i);
    OrganSettings settings;
    settings.name = spec.name, settings.structure = spec.model, settings.lattice = spec.lattice;
    settings.has_softening = spec.softening, settings.material = resolve_material(spec.material).material;
    settings.damage_depth = spec.damage_depth, settings.guides = guides_of(spec, organs[i]);
    const std::size_t errors_before = errors.size();
    settings.layers = layers_of(spec, organs[i], where, errors);
    Result<std::vector<std::int32_t>> anchored = select_anchored(organs[i], spec.anchors, scene.gravity, where);
    if (!anchored) {
      errors.insert(errors.end(), anchored.errors().begin(), anchored.errors().end());
      continue;
    }
    if (errors.size() > errors_before) continue;
    built.anchored_count.push_back(std::int32_t(anchored->size()));
    settings.anchored = std::move(*anchored);
    const std::size_t elements_before = model.element_count();
    if (Result<Done> added = add_organ(model, organs[i], settings); !added) {
      for (const Error& error : added.errors())
        errors.push_back({where, error.where + ": " + error.message, error.hint});
    } else if (model.element_count() == elements_before) {
      errors.push_back({where,
                        "no two of its " + std::to_string(organs[i].centre.size()) +
                            " spheres are neighbours, so nothing joins them",
                        "fill it with smaller spheres"});
    }
  }
  if (!errors.empty()) return errors;
  add_tools(model, scene);
  add_cutting(model, scene);
  for (const LoadSpec& load : scene.loads) {
    model.loads.sphere.push_back(nearest_sphere(model, load.at));
    model.loads.force.push_back(load.force);
    model.loads.start.push_back(load.start), model.loads.ramp.push_back(load.ramp);
  }
  for (const ProbeSpec& probe : scene.probes) built.probe_sphere.push_back(nearest_sphere(model, probe.at));
  const SolverSettings standard;
  model.solver.tolerance = scene.solver.tolerance.value_or(standard.tolerance);
  model.solver.velocity_floor = scene.solver.velocity_floor.value_or(standard.velocity_floor);
  model.solver.max_iterations = scene.solver.max_iterations.value_or(standard.max_iterations);
  model.solver.integrator = scene.solver.integrator;
  model.solver.substeps = scene.solver.substeps.value_or(standard.substeps);
  if (const IntegratorChoice choice = choose_integrator(model); !choice.holds)
    return Errors{{"/solver/integrator", std::string(name_of(choice.integrator)) + ": " + choice.reason,
                   "take `auto`, `backward-euler`, or more substeps"}};
  return built;
}

}  // namespace ctpm
