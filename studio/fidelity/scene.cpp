#include "studio/fidelity/scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/stepping/integrator.h"
#include "scenes/anchors.h"
#include "scenes/build_model.h"
#include "scenes/script.h"
#include "studio/loading/loaded_scene.h"
#include "studio/output/number_text.h"

namespace ctpm::fidelity {
namespace {

const Errors kStopped{{"", "stopped", ""}};
constexpr double kDeepest = 12e-3;      // [m]
constexpr double kShareOfOrgan = 0.25;  // a press goes no deeper than this share of the organ's extent along its way

/// The first press of the script: where the ball is before it, and its way. False if there is none.
bool find_press(const scenes::Script& script, const std::string& ball, SceneOrgan& organ) {
  bool has_ball = false;
  for (const scenes::ScriptStep& step : script.steps) {
    if (step.take) has_ball = step.take->tool == ball, organ.start = step.take->at;
    if (!step.press || !has_ball) continue;
    organ.direction = step.press->direction / norm(step.press->direction);
    return true;
  }
  return false;
}

/// Only the first organ and one ball, as slow as can be.
scenes::SceneSpec slow_scene(const scenes::SceneSpec& scene, const scenes::ToolSpec& ball) {
  scenes::SceneSpec slow;
  slow.name = scene.name, slow.gravity = {};
  slow.organs = {scene.organs[0]}, slow.tools = {ball};
  slow.contact_stiffness = scene.contact_stiffness, slow.contact_friction = scene.contact_friction;
  slow.contact_damping = scene.contact_damping;
  scenes::OrganSpec& organ = slow.organs[0];
  organ.anchors.clear();
  organ.material.viscosity = 0;
  for (scenes::LayerSpec& layer : organ.layers) layer.material.viscosity = 0;
  use_slow_pace(slow);
  return slow;
}

/// Extent of a mesh along a way [m].
double extent_along(const importers::RawMesh& mesh, Vec3 way) {
  double least = INFINITY, most = -INFINITY;
  for (const Vec3& v : mesh.vertex) least = std::min(least, dot(v, way)), most = std::max(most, dot(v, way));
  return most - least;
}

Surface as_surface(const importers::RawMesh& mesh) {
  Surface surface;
  surface.vertex = mesh.vertex, surface.triangle = mesh.triangle;
  return surface;
}

}  // namespace

Result<SceneOrgan> read_scene_organ(const std::string& path, const scenes::LoadOptions& options) {
  const Result<loading::LoadedScene> loaded = loading::load_whole_scene(path, options);
  if (!loaded) return loaded.errors();
  const scenes::SceneSpec& spec = loaded->scene.spec;
  const auto ball = std::find_if(spec.tools.begin(), spec.tools.end(),
                                 [](const scenes::ToolSpec& tool) { return tool.kind == ToolKind::ball; });
  Errors errors;
  if (spec.organs[0].rig)
    errors.push_back(loaded->scene.places.error_at("/organs/0/rig", "a rig has no mesh that could be turned"));
  if (ball == spec.tools.end())
    errors.push_back(loaded->scene.places.error_at("/tools", "there is no ball that could press the organ"));
  if (!errors.empty()) return errors;
  SceneOrgan organ;
  if (!find_press(scenes::default_script(spec, loaded->organs), ball->name, organ))
    return Error{path, "its default script presses nothing", ""};
  const Result<importers::ImportedOrgan> imported = loading::fill_of(path, spec.organs[0]);
  if (!imported) return imported.errors();
  organ.scene = slow_scene(spec, *ball);
  organ.anchors = spec.organs[0].anchors, organ.gravity = spec.gravity;
  organ.mesh.path = spec.organs[0].mesh;
  organ.mesh.vertex = imported->mesh.vertex, organ.mesh.triangle = imported->mesh.triangle;
  organ.middle = 0.5 * (imported->mesh.box_least + imported->mesh.box_most);
  const double deepest = std::min(kDeepest, kShareOfOrgan * extent_along(organ.mesh, organ.direction));
  organ.depths = {deepest / 3, 2 * deepest / 3, deepest};
  if (!find_touch(organ, {})) return Error{path, "the press of its default script misses the organ", ""};
  return organ;
}

std::optional<PressSite> find_touch(const SceneOrgan& organ, Vec3 offset) {
  constexpr double kClose = 1e-7;  // [m]
  const Surface surface = as_surface(organ.mesh);
  const double radius = *organ.scene.tools[0].radius, longest = extent_along(organ.mesh, organ.direction) + 0.1;
  const Vec3 from = organ.start + offset;
  // The distance bounds how far the ball may go on without touching.
  for (double way = 0; way < longest;) {
    const double apart = distance_to(surface, surface.vertex, from + way * organ.direction) - radius;
    if (apart < kClose) return PressSite{from + (way + radius) * organ.direction, organ.direction};
    way += apart;
  }
  return std::nullopt;
}

Result<Body> make_body(const SceneOrgan& organ, Quat turn) {
  importers::FillOptions options;
  const scenes::OrganSpec& spec = organ.scene.organs[0];
  options.keep_islands = spec.all_parts, options.most_triangles = spec.most_triangles.value_or(0);
  Result<Body> body = make_body(organ.scene, organ.mesh, turn, organ.middle - rotate(turn, organ.middle), options);
  if (!body || organ.anchors.empty()) return body;
  // Anchors are regions of the scene, so they choose among spheres that are turned back.
  FilledOrgan back = body->organ;
  for (Vec3& centre : back.centre) centre = body->to_body(centre);
  for (Vec3& vertex : back.surface.vertex) vertex = body->to_body(vertex);
  const Result<std::vector<std::int32_t>> anchored =
      scenes::select_anchored(back, organ.anchors, organ.gravity, "the turned organ");
  if (!anchored) return anchored.errors();
  hold(body->model, *anchored, kAnchored);
  return body;
}

Result<SceneResult> measure_scene_turns(const SceneOrgan& organ, std::span<const Quat> turns,
                                        const ShouldStop& should_stop) {
  const PressSite site = *find_touch(organ, {});
  SceneResult result;
  result.name = organ.scene.name + ", organ " + organ.scene.organs[0].name + ", " + organ.scene.tools[0].name + " of " +
                output::short_number(1e3 * *organ.scene.tools[0].radius) + " mm";
  result.radius = organ.scene.organs[0].fill.radius, result.spacing = organ.scene.organs[0].fill.spacing();
  std::vector<std::vector<PressPoint>> presses(turns.size());
  std::vector<Errors> errors(turns.size());
  in_parallel(turns.size(), [&](std::size_t i) {
    if (should_stop && should_stop()) return void(errors[i] = kStopped);
    const Result<Body> body = make_body(organ, turns[i]);
    if (!body)
      errors[i] = body.errors();
    else
      presses[i] = press(*body, 0, site, organ.depths);
    if (body && i == 0) result.spheres = body->model.sphere_count();
  });
  for (const Errors& e : errors)
    if (!e.empty()) return e;
  result.turns = rows_of(presses, result.radius, organ.depths);
  return result;
}

Result<SceneResult> measure_scene_places(const SceneOrgan& organ, int places, const ShouldStop& should_stop) {
  const Result<Body> body = make_body(organ, Quat{});
  if (!body) return body.errors();
  SceneResult result;
  result.name = organ.scene.name + ", organ " + organ.scene.organs[0].name;
  result.radius = organ.scene.organs[0].fill.radius, result.spacing = body->spacing();
  result.spheres = body->model.sphere_count();
  const Vec3 helper = std::abs(organ.direction.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = cross(organ.direction, helper) / norm(cross(organ.direction, helper)), v = cross(organ.direction, u);
  std::vector<PressSite> sites;
  for (int i = 0; i < places; ++i)
    for (int j = 0; j < places; ++j)
      if (const auto site = find_touch(organ, result.spacing / places * (i * u + j * v))) sites.push_back(*site);
  std::vector<std::vector<PressPoint>> presses(sites.size());
  result.contacts.resize(sites.size());
  std::atomic<bool> was_stopped{false};
  in_parallel(sites.size(), [&](std::size_t i) {
    if (should_stop && should_stop()) return void(was_stopped = true);
    presses[i] = press(*body, 0, sites[i], organ.depths);
    result.contacts[i] = first_contact(*body, 0, sites[i]);
  });
  if (was_stopped) return kStopped;
  result.places = rows_of(presses, result.radius, organ.depths);
  return result;
}

Chapter turns_chapter(const SceneResult& result, const std::string& key, const std::string& title) {
  Chapter chapter;
  chapter.section.key = key, chapter.section.title = title;
  chapter.section.paragraphs = {
      result.name + ": the organ with its anchors and its tool is turned against the lattice, " +
      std::to_string(result.turns.empty() ? 0 : result.turns[0].forces.size()) +
      " times, and pressed where the scene's default script presses first; no gravity, and it rests at each depth. " +
      std::to_string(result.spheres) + " spheres as it lies in the scene."};
  add_scatter(chapter, result.turns, "turns");
  return chapter;
}

Chapter places_chapter(const SceneResult& result, const std::string& key, const std::string& title) {
  Chapter chapter;
  chapter.section.key = key, chapter.section.title = title;
  chapter.section.paragraphs = {result.name + ": the ball presses beside the place of the default script, " +
                                std::to_string(result.contacts.size()) + " places over one lattice spacing (" +
                                output::short_number(1e3 * result.spacing) +
                                " mm). Depths count from where the ball touches the drawn surface, so a smooth organ "
                                "answers alike but for its own curvature; the first contact is the depth at which a "
                                "force is felt."};
  add_scatter(chapter, result.places, "places");
  add_contacts(chapter, {{result.radius, 0, result.contacts}});
  return chapter;
}

}  // namespace ctpm::fidelity
