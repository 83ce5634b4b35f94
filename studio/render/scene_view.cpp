#include "studio/render/scene_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

namespace ctpm::render {

OrganLook look_of(std::string_view organ_name) {
  OrganLook look{std::string(organ_name), {0.53, 0.20, 0.17}, {0.50, 0.08, 0.08}, 1};
  const auto has = [&](std::string_view word) { return organ_name.find(word) != std::string_view::npos; };
  if (has("liver")) look.outer = {0.42, 0.15, 0.115}, look.inner = {0.43, 0.07, 0.06};
  if (has("kidney")) look.outer = {0.56, 0.235, 0.20}, look.inner = {0.56, 0.12, 0.11};
  if (has("skin"))
    look.outer = {0.86, 0.67, 0.57}, look.inner = {0.76, 0.30, 0.26}, look.wetness = 0.25, look.blood = 0.7;
  return look;
}

std::vector<Vec3> rest_points(const SceneView& scene) {
  std::vector<Vec3> points;
  for (const Surface& surface : scene.model->surfaces)
    points.insert(points.end(), surface.vertex.begin(), surface.vertex.end());
  return points;
}

Bounds rest_bounds(const SceneView& scene) { return bounds_of(rest_points(scene)); }

Camera fitted_camera(const SceneView& scene, Vec3 direction, Vec3 up, double fov_deg, double aspect) {
  return fit_camera(rest_points(scene), direction, up, fov_deg, aspect);
}

Camera section_camera(const SceneView& scene, Vec3 place, Vec3 normal, Vec3 direction, Vec3 up, double fov_deg,
                      double aspect) {
  std::vector<Vec3> points = rest_points(scene);
  for (Vec3& p : points) p += dot(place - p, normal) * normal;
  return fit_camera(points, direction, up, fov_deg, aspect);
}

Vec3 up_of(const Model& model) {
  const double strength = norm(model.gravity);
  return strength > 0 ? -model.gravity / strength : Vec3{0, 0, 1};
}

Camera default_camera(const SceneView& scene, double aspect) {
  const Vec3 up = up_of(*scene.model);
  Vec3 side = cross(std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, up);
  side = side / norm(side);  // -y when z is up
  const Vec3 right = cross(up, side);
  const Vec3 from = side + 0.45 * -right + 0.62 * up;
  return fitted_camera(scene, -from, up, 32, aspect);
}

namespace {

/// Nearness of the tool in a hand to the organs: 0 far away, 1 at work.
double nearness(const Bounds& organs, const Hand& hand) {
  if (hand.tool < 0) return 0;
  const Vec3 p = hand.position;
  const auto beyond = [](double low, double high, double x) { return std::max({low - x, x - high, 0.0}); };
  const double away = norm(Vec3{beyond(organs.min.x, organs.max.x, p.x), beyond(organs.min.y, organs.max.y, p.y),
                                beyond(organs.min.z, organs.max.z, p.z)});
  const double t = std::clamp(1 - away / (0.35 * organs.diagonal()), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Where a hand is seen to work: a blade's tip is inside the tissue.
Vec3 work_place(const Model& model, const Hand& hand) {
  constexpr double kUpTheBlade = 0.4;
  if (!model.is_scalpel(hand.tool)) return hand.position;
  const double length = model.tools[std::size_t(hand.tool)].blade_length;
  return hand.position + rotate(hand.world_from_tool, {0, 0, kUpTheBlade * length});
}

/// Ticks between two moments.
std::size_t moment_ticks(double tick) {
  constexpr double kEvery = 0.01;  // [s]
  return std::size_t(std::max(1ll, std::llround(kEvery / tick)));
}

}  // namespace

std::size_t followed_ticks(double tick) { return kFollowedMoments * moment_ticks(tick); }

std::vector<Inputs> followed_moments(std::size_t count, double tick,
                                     const std::function<const Inputs&(std::size_t)>& inputs) {
  const std::size_t every = moment_ticks(tick), most = std::min(count, followed_ticks(tick));
  std::vector<Inputs> moments;
  for (std::size_t back = 0; back < most; back += every) moments.push_back(inputs(count - 1 - back));
  std::reverse(moments.begin(), moments.end());
  return moments;
}

Camera following_camera(const SceneView& scene, const Camera& base, std::span<const Inputs> moments) {
  constexpr double kClosest = 0.6;  // of the base camera's distance
  const Bounds organs = rest_bounds(scene);
  // Weights rise and fall, so that the camera starts and stops smoothly after a sudden change.
  double sum = 0, near = 0;
  Vec3 pull;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const double age = std::min(1.0, (double(moments.size() - 1 - i) + 0.5) / kFollowedMoments);
    const double first = nearness(organs, moments[i]), second = nearness(organs, moments[i].second);
    Vec3 place = work_place(*scene.model, moments[i]);
    if (second > 0) place += second / (first + second) * (work_place(*scene.model, moments[i].second) - place);
    const double weight = age * (1 - age), part = weight * std::max(first, second);
    sum += weight, near += part, pull += part * (place - base.target);
  }
  if (sum == 0 || near == 0) return base;
  Camera camera = base;
  camera.target = base.target + 0.85 / sum * pull;
  camera.eye = camera.target + (1 - near / sum * (1 - kClosest)) * (base.eye - base.target);
  return camera;
}

namespace {

/// The colour at `place` in [0, 1], interpolated between equal steps.
Colour on_ladder(std::span<const Colour> ladder, double place) {
  const double steps = std::clamp(place, 0.0, 1.0) * double(ladder.size() - 1);
  const std::size_t low = std::min(std::size_t(steps), ladder.size() - 2);
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = ladder[low][c] + (steps - double(low)) * (ladder[low + 1][c] - ladder[low][c]);
  return colour;
}

}  // namespace

double default_full_scale(ElementQuantity quantity) {
  return quantity == ElementQuantity::stretch ? 0.2 : quantity == ElementQuantity::tilt ? 0.5 : 0.05;
}

Colour quantity_colour(ElementQuantity quantity, double value) {
  static constexpr Colour kBothWays[] = {
      {0.10, 0.25, 0.75}, {0.35, 0.60, 0.90}, {0.80, 0.80, 0.80}, {0.95, 0.55, 0.35}, {0.75, 0.10, 0.12}};
  static constexpr Colour kOneWay[] = {
      {0.16, 0.17, 0.42}, {0.16, 0.42, 0.60}, {0.25, 0.66, 0.52}, {0.75, 0.82, 0.32}, {1.00, 0.92, 0.45}};
  return quantity == ElementQuantity::stretch ? on_ladder(kBothWays, 0.5 + 0.5 * value) : on_ladder(kOneWay, value);
}

Colour layer_colour(int layer, int layer_count) {
  // From the skin inwards: rose, amber, green, blue, indigo, violet; few layers take the first steps only.
  static constexpr Colour kLadder[] = {{0.84, 0.40, 0.38}, {0.93, 0.66, 0.32}, {0.62, 0.72, 0.36},
                                       {0.30, 0.62, 0.68}, {0.36, 0.42, 0.75}, {0.55, 0.33, 0.66}};
  const int last = std::max(layer_count - 1, int(std::size(kLadder)) - 1);
  return on_ladder(kLadder, double(layer - 1) / last);
}

std::vector<std::uint8_t> spheres_at_cuts(const Model& model, const State& state) {
  std::vector<std::uint8_t> at_cut;
  for (std::size_t i = 0; i < state.axial_severed.size(); ++i) {
    if (!state.axial_severed[i]) continue;
    if (at_cut.empty()) at_cut.assign(model.sphere_count(), 0);
    at_cut[std::size_t(model.axial.a[i])] = at_cut[std::size_t(model.axial.b[i])] = 1;
  }
  return at_cut;
}

Legend legend_of(const Model& model, const DrawOptions& options) {
  if (options.view == View::surface) return {};
  Legend legend;
  if (options.view != View::elements) {
    int layers = 1;
    for (const OrganRange& organ : model.organs) layers = std::max(layers, int(organ.layer_count));
    const bool can_cut =
        std::ranges::any_of(model.tools, [](const Tool& tool) { return tool.kind == ToolKind::scalpel; });
    legend = {can_cut ? "layer, red: cut" : "layer", "1", std::to_string(layers), {}, true};
    for (int layer = 1; layer <= layers; ++layer) legend.colours.push_back(layer_colour(layer, layers));
    return legend;
  }
  const double scale = options.full_scale > 0 ? options.full_scale : default_full_scale(options.quantity);
  const auto text = [](const char* format, double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, format, value);
    return std::string(buffer);
  };
  const bool both_ways = options.quantity == ElementQuantity::stretch;
  switch (options.quantity) {
    case ElementQuantity::stretch:
      legend = {"stretch [%]", text("%.3g", -100 * scale), text("+%.3g", 100 * scale), {}, false};
      break;
    case ElementQuantity::tilt:
      legend = {"tilt [deg]", "0", text("%.3g", scale * 180 / std::numbers::pi), {}, false};
      break;
    case ElementQuantity::force:
      legend = {"force [N]", "0", text("%.3g", scale), {}, false};
      break;
  }
  for (int i = 0; i <= 16; ++i)
    legend.colours.push_back(quantity_colour(options.quantity, both_ways ? i / 8.0 - 1 : i / 16.0));
  return legend;
}

}  // namespace ctpm::render
