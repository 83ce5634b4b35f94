#include "studio/authoring/fit_stiffness.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/stepping/step.h"
#include "scenes/anchors.h"
#include "scenes/build_model.h"
#include "scenes/places.h"
#include "scenes/presets.h"
#include "studio/authoring/anchor_choice.h"
#include "studio/output/number_text.h"
#include "studio/rig/site.h"

namespace ctpm::authoring {
namespace {

constexpr double kDepths[] = {2e-3, 4e-3, 6e-3, 8e-3, 10e-3, 12e-3};  ///< of Table 1 [m]
constexpr double kFitDepth = 12e-3;

/// Largest difference from Table 1 at the depth of the fit [share].
constexpr double kFitBound = 0.002;
constexpr int kMostRounds = 4;
constexpr double kFirstSpeed = 20e-3;  ///< of the ball in the first round [m/s]

Vec3 up_in(const scenes::SceneSpec& scene) {
  return norm(scene.gravity) > 0 ? -1.0 * scene.gravity / norm(scene.gravity) : Vec3{0, 0, 1};
}

void multiply_scale(scenes::MaterialSpec& material, double factor) {
  material.stiffness_scale = factor * scenes::resolve_material(material).material.stiffness_scale;
}

/// Tissue that has crept, excised.
void make_slow(scenes::MaterialSpec& material, double factor) {
  material.viscosity = 0, material.prestrain = 0;
  multiply_scale(material, factor);
}

/// Says what lies lowest under `gravity` as a plane: the scene of a fit has no gravity.
void make_plane(scenes::AnchorSpec& anchor, const FilledOrgan& filled, Vec3 gravity, Vec3 up) {
  if (!anchor.lowest) return;
  anchor.plane = scenes::PlaneRegion{(scenes::lowest_height(filled, gravity) + *anchor.lowest) * up, up};
  anchor.lowest.reset();
}

/// The scene with that organ alone, without gravity and viscosity, and with the calibration's ball as its tool, which
/// would push away what nothing holds.
scenes::SceneSpec slow_scene(const scenes::SceneSpec& scene, std::size_t organ, const FilledOrgan& filled,
                             double factor) {
  scenes::SceneSpec slow;
  slow.name = scene.name, slow.gravity = {}, slow.tick = 10e-3;
  slow.organs = {scene.organs[organ]};
  scenes::OrganSpec& own = slow.organs[0];
  if (!own.rig && own.anchors.empty()) own.anchors = {usual_anchor(filled)};
  for (scenes::AnchorSpec& anchor : own.anchors) make_plane(anchor, filled, scene.gravity, up_in(scene));
  make_slow(own.material, factor);
  for (scenes::LayerSpec& layer : own.layers) make_slow(layer.material, factor);
  scenes::ToolSpec ball;
  ball.name = "ball", ball.kind = ToolKind::ball, ball.radius = 1e-3 * rig::site_of(own).ball_radius;
  slow.tools = {ball};
  slow.contact_friction = scene.contact_friction;
  slow.solver.tolerance = 1e-6, slow.solver.velocity_enough = 0, slow.solver.max_iterations = 2000;
  return slow;
}

/// Points that the ball touches first: nine over one lattice cell at the top of the surface, or the top of a rig's
/// highest sphere that can move. Empty if nothing can move there.
std::vector<Vec3> places_at_top(const Model& model, const FilledOrgan& filled, Vec3 up) {
  const auto height = [&](Vec3 p) { return dot(p, up); };
  std::optional<std::size_t> sphere;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (filled.layer[i] == 1 && model.held_axes[i] == 0 &&
        (!sphere || height(model.rest_position[i]) > height(model.rest_position[*sphere]) + 1e-9))
      sphere = i;
  if (!sphere) return {};
  const Surface& surface = filled.surface;
  if (surface.triangle.empty()) return {model.rest_position[*sphere] + model.contact_radius[*sphere] * up};
  const Vec3 top = *std::max_element(surface.vertex.begin(), surface.vertex.end(),
                                     [&](Vec3 p, Vec3 q) { return height(p) < height(q); });
  const Vec3 beside = std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = cross(up, beside) / norm(cross(up, beside)), v = cross(up, u);
  std::vector<Vec3> places;
  for (const int i : {-1, 0, 1})
    for (const int j : {-1, 0, 1})
      if (const auto place =
              scenes::surface_above(surface, top + filled.spacing / 3 * (double(i) * u + double(j) * v), up))
        places.push_back(*place);
  return places;
}

/// Force [N] at each of kDepths below `place`; none if the ball loses the organ or a step fails.
std::optional<std::vector<double>> press(const Model& model, Vec3 place, Vec3 up, double speed) {
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  std::vector<double> forces;
  double last_depth = 0, last_force = 0;
  while (forces.size() < std::size(kDepths)) {
    const double depth = last_depth + speed * model.tick;
    Inputs inputs;
    inputs.tool = 0, inputs.position = place + (model.tools[0].radius - depth) * up;
    const stepping::StepReport report = stepper.step(state, inputs);
    if (report.status != stepping::StepStatus::ok) return std::nullopt;
    const double force = dot(report.tool_force, up);
    if (force <= 0 && depth > 1e-3) return std::nullopt;
    // Interpolates linearly between two ticks.
    while (forces.size() < std::size(kDepths) && depth >= kDepths[forces.size()]) {
      const double share = (kDepths[forces.size()] - last_depth) / (depth - last_depth);
      forces.push_back(last_force + share * (force - last_force));
    }
    last_depth = depth, last_force = force;
  }
  return forces;
}

/// Mean and scatter over the places; none if a press fails or `next_press` stops it.
std::optional<std::vector<FitRow>> press_all(const Model& model, const std::vector<Vec3>& places, Vec3 up,
                                             const rig::Site& site, double speed,
                                             const std::function<bool()>& next_press) {
  std::vector<std::vector<double>> all;
  for (const Vec3& place : places) {
    if (!next_press()) return std::nullopt;
    const auto forces = press(model, place, up, speed);
    if (!forces) return std::nullopt;
    all.push_back(*forces);
  }
  std::vector<FitRow> rows;
  for (std::size_t d = 0; d < std::size(kDepths); ++d) {
    double mean = 0, square = 0;
    for (const auto& forces : all) mean += forces[d] / double(all.size());
    for (const auto& forces : all) square += (forces[d] - mean) * (forces[d] - mean) / double(all.size());
    rows.push_back({kDepths[d], mean, std::sqrt(square) / mean, rig::table_force(site, 1e3 * kDepths[d], true)});
  }
  return rows;
}

}  // namespace

Result<StiffnessFit> fit_stiffness(const scenes::SceneSpec& scene, std::size_t organ, const FilledOrgan& filled,
                                   const std::function<bool()>& should_stop, const FitProgress& progress) {
  const scenes::OrganSpec& spec = scene.organs[organ];
  const std::string where = "organ " + spec.name;
  const std::vector<FilledOrgan> only{filled};
  const Vec3 up = up_in(scene);
  const rig::Site site = rig::site_of(spec);
  const auto build = [&](double factor) { return scenes::build_model(slow_scene(scene, organ, filled, factor), only); };

  const Result<scenes::BuiltScene> first = build(1);
  if (!first) return first.errors();
  const std::vector<Vec3> places = places_at_top(first->model, filled, up);
  if (places.empty())
    return Error{where, "no outermost sphere can move, so nothing can be pressed", "anchor less of it"};
  const std::int64_t most = (1 + kMostRounds) * std::int64_t(places.size());
  std::int64_t begun = 0;
  const auto next_press = [&] {
    if (progress) progress(begun++, most);
    return !(should_stop && should_stop());
  };
  StiffnessFit fit;
  std::optional<std::vector<FitRow>> rows = press_all(first->model, places, up, site, kFirstSpeed, next_press);
  // Force is proportional to the scale except for inertia, because mass is not scaled; the next round corrects this.
  for (int round = 0; round < kMostRounds && rows; ++round) {
    fit.factor *= rows->back().closed_form / rows->back().force;
    const Result<scenes::BuiltScene> scaled = build(fit.factor);
    if (!scaled) return scaled.errors();
    rows = press_all(scaled->model, places, up, site, 0.5 * kFirstSpeed, next_press);
    if (rows && std::abs(rows->back().error()) <= kFitBound) break;
  }
  if (!rows && should_stop && should_stop()) return Error{where, "stopped", ""};
  if (!rows || std::abs(rows->back().error()) > kFitBound)
    return Error{where,
                 "the ball of " + output::fixed(site.ball_radius, 1) + " mm loses the organ before it is 12 mm deep",
                 "the organ may be too thin or its spheres too small"};
  fit.scale = fit.factor * scenes::resolve_material(spec.material).material.stiffness_scale;
  fit.fitted_for = {places[places.size() / 2], first->model.tools[0].radius, filled.sphere_radius, kFitDepth,
                    rows->back().force};
  fit.rows = *rows;
  return fit;
}

void apply_fit(scenes::OrganSpec& organ, const StiffnessFit& fit) {
  // Six digits exceed the fit's accuracy and stay readable in a scene.
  const auto rounded = [](double value) { return std::stod(output::short_number(value, 6)); };
  for (scenes::LayerSpec& layer : organ.layers)
    layer.material.stiffness_scale =
        rounded(fit.factor * scenes::resolve_material(layer.material).material.stiffness_scale);
  organ.material.stiffness_scale = rounded(fit.scale);
  scenes::FittedForSpec fitted = fit.fitted_for;
  const auto to_micrometre = [](double length) { return std::round(length * 1e6) / 1e6; };
  fitted.place = {to_micrometre(fitted.place.x), to_micrometre(fitted.place.y), to_micrometre(fitted.place.z)};
  fitted.force = rounded(fitted.force);
  organ.material.fitted_for = fitted;
}

}  // namespace ctpm::authoring
