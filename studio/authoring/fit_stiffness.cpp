#include "studio/authoring/fit_stiffness.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>

#include "core/stepping/step.h"
#include "scenes/build_model.h"
#include "scenes/presets.h"
#include "studio/output/number_text.h"
#include "studio/rig/site.h"

namespace ctpm::authoring {
namespace {

constexpr double kDepths[] = {2e-3, 4e-3, 6e-3, 8e-3, 10e-3, 12e-3};  ///< of Table 1 [m]
constexpr double kFitDepth = 12e-3;

/// The ball has slipped off if the sphere is not at the depth of the fit after this much more displacement of the ball
/// [m].
constexpr double kLongestWay = 30e-3;

/// Largest number of spheres to try.
constexpr std::size_t kMostTries = 8;

/// Largest difference from Table 1 at the depth of the fit [share].
constexpr double kFitBound = 0.002;
constexpr int kMostRounds = 4;

Vec3 up_in(const scenes::SceneSpec& scene) {
  return norm(scene.gravity) > 0 ? -1.0 * scene.gravity / norm(scene.gravity) : Vec3{0, 0, 1};
}

void multiply_scale(scenes::MaterialSpec& material, double factor) {
  material.stiffness_scale = factor * scenes::resolve_material(material).material.stiffness_scale;
}

/// The scene with that organ alone, without gravity and viscosity, and with the calibration's ball as its tool.
scenes::SceneSpec slow_scene(const scenes::SceneSpec& scene, std::size_t organ, double factor) {
  scenes::SceneSpec slow;
  slow.name = scene.name, slow.gravity = {}, slow.tick = 10e-3;
  slow.organs = {scene.organs[organ]};
  scenes::OrganSpec& own = slow.organs[0];
  own.material.viscosity = 0, multiply_scale(own.material, factor);
  for (scenes::LayerSpec& layer : own.layers) layer.material.viscosity = 0, multiply_scale(layer.material, factor);
  scenes::ToolSpec ball;
  ball.name = "ball", ball.kind = ToolKind::ball, ball.radius = 1e-3 * rig::site_of(own).ball_radius;
  slow.tools = {ball};
  slow.contact_friction = scene.contact_friction;
  slow.solver.tolerance = 1e-6, slow.solver.max_iterations = 2000;
  return slow;
}

/// Force [N] at each of kDepths; none if the ball slips off or a step fails.
std::optional<std::vector<double>> press(const Model& model, std::int32_t sphere, Vec3 up, double speed) {
  const auto c = std::size_t(sphere);
  const Vec3 touch = model.rest_position[c] + (model.tools[0].radius + model.contact_radius[c]) * up;
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  std::vector<double> forces;
  double last_depth = 0, last_force = 0;
  for (double way = 0; way < kFitDepth + kLongestWay && forces.size() < std::size(kDepths); way += speed * model.tick) {
    Inputs inputs;
    inputs.tool = 0, inputs.position = touch - way * up;
    const stepping::StepReport report = stepper.step(state, inputs);
    if (report.status != stepping::StepStatus::ok) return std::nullopt;
    const double depth = dot(model.rest_position[c] - state.position[c], up), force = dot(report.tool_force, up);
    // Interpolates linearly between two ticks.
    while (forces.size() < std::size(kDepths) && depth >= kDepths[forces.size()]) {
      const double share = (kDepths[forces.size()] - last_depth) / (depth - last_depth);
      forces.push_back(last_force + share * (force - last_force));
    }
    last_depth = depth, last_force = force;
  }
  if (forces.size() < std::size(kDepths)) return std::nullopt;
  return forces;
}

/// Number of spheres in the eight cells one and two steps beside each sphere, perpendicular to `up`; the paper's C has
/// all eight. -1 for a sphere below another one, which the ball would touch first.
std::vector<int> neighbours_across(const FilledOrgan& filled, Vec3 up) {
  const std::set<std::array<std::int32_t, 3>> cells(filled.cell.begin(), filled.cell.end());
  const double along[3] = {up.x, up.y, up.z};
  const auto up_axis = std::size_t(
      std::max_element(along, along + 3, [](double p, double q) { return std::abs(p) < std::abs(q); }) - along);
  std::vector<int> counts;
  for (const std::array<std::int32_t, 3>& cell : filled.cell) {
    int count = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int step : {-2, -1, 1, 2}) {
        std::array<std::int32_t, 3> beside = cell;
        beside[axis] += step;
        count += axis != up_axis && cells.contains(beside) ? 1 : 0;
      }
    std::array<std::int32_t, 3> above = cell;
    above[up_axis] += along[up_axis] > 0 ? 1 : -1;
    if (cells.contains(above)) count = -1;
    counts.push_back(count);
  }
  return counts;
}

/// Outermost spheres near the top that can move. Those with the most neighbours come first, as for the paper's C,
/// because a protruding sphere moves sideways; then the highest, then the nearest to the organ's middle.
std::vector<std::int32_t> top_spheres(const Model& model, const FilledOrgan& filled, Vec3 up) {
  Vec3 middle;
  for (const Vec3& centre : filled.centre) middle += centre / double(filled.centre.size());
  const auto level = [&](std::int32_t i) {
    return std::lround(2 * dot(model.rest_position[std::size_t(i)] - middle, up) / filled.spacing);
  };
  std::vector<std::int32_t> spheres;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (filled.layer[i] == 1 && model.held_axes[i] == 0) spheres.push_back(std::int32_t(i));
  if (spheres.empty()) return spheres;
  const long top = level(*std::max_element(spheres.begin(), spheres.end(),
                                           [&](std::int32_t p, std::int32_t q) { return level(p) < level(q); }));
  const std::vector<int> neighbours = neighbours_across(filled, up);
  // Near the top: within two spacings.
  std::erase_if(spheres, [&](std::int32_t i) { return level(i) < top - 4 || neighbours[std::size_t(i)] < 0; });
  const auto order = [&](std::int32_t i) {
    const Vec3 apart = model.rest_position[std::size_t(i)] - middle;
    return std::tuple(-neighbours[std::size_t(i)], -level(i), norm(apart - dot(apart, up) * up));
  };
  std::stable_sort(spheres.begin(), spheres.end(), [&](std::int32_t p, std::int32_t q) { return order(p) < order(q); });
  spheres.resize(std::min(spheres.size(), kMostTries));
  return spheres;
}

}  // namespace

Result<StiffnessFit> fit_stiffness(const scenes::SceneSpec& scene, std::size_t organ, const FilledOrgan& filled) {
  const scenes::OrganSpec& spec = scene.organs[organ];
  const std::string where = "organ " + spec.name;
  const std::vector<FilledOrgan> only{filled};
  const Vec3 up = up_in(scene);
  const rig::Site site = rig::site_of(spec);
  const double wanted = rig::table_force(site, 1e3 * kFitDepth, true);
  const auto build = [&](double factor) { return scenes::build_model(slow_scene(scene, organ, factor), only); };

  const Result<scenes::BuiltScene> first = build(1);
  if (!first) return first.errors();
  const std::vector<std::int32_t> tries = top_spheres(first->model, filled, up);
  if (tries.empty())
    return Error{where, "no outermost sphere can move, so nothing can be pressed", "anchor less of it"};
  StiffnessFit fit;
  for (const std::int32_t sphere : tries) {
    std::optional<std::vector<double>> forces = press(first->model, sphere, up, 20e-3);
    if (!forces || !(forces->back() > 0)) continue;
    fit.factor = 1;
    // Force is proportional to the scale except for inertia, because mass is not scaled; the next round corrects this.
    for (int round = 0; round < kMostRounds; ++round) {
      fit.factor *= wanted / forces->back();
      const Result<scenes::BuiltScene> scaled = build(fit.factor);
      if (!scaled) return scaled.errors();
      forces = press(scaled->model, sphere, up, 10e-3);
      if (!forces || std::abs(forces->back() / wanted - 1) <= kFitBound) break;
    }
    if (!forces || std::abs(forces->back() / wanted - 1) > kFitBound) continue;
    fit.scale = fit.factor * scenes::resolve_material(spec.material).material.stiffness_scale;
    fit.fitted_for = {first->model.rest_position[std::size_t(sphere)], first->model.tools[0].radius,
                      filled.sphere_radius, kFitDepth, forces->back()};
    for (std::size_t i = 0; i < std::size(kDepths); ++i)
      fit.rows.push_back({kDepths[i], (*forces)[i], rig::table_force(site, 1e3 * kDepths[i], true)});
    return fit;
  }
  return Error{where,
               "the ball of " + output::fixed(site.ball_radius, 1) + " mm slips off each of " +
                   std::to_string(tries.size()) + " spheres at the top before it is 12 mm deep",
               "the organ may be too thin or its spheres too small"};
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
