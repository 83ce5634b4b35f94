#include "studio/views/wound_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <vector>

#include "core/contact/drawn_surfaces.h"
#include "core/model/box.h"
#include "studio/render/cut_surface.h"
#include "studio/render/renderer.h"

namespace ctpm::views {
namespace {

using render::Camera;

/// Walls farther from the organs at rest than this part of their size are those of pieces that fell or flew away.
constexpr double kGone = 0.5;

/// Where the walls of all cuts are [m], without those of pieces that are gone.
std::vector<Vec3> walls_of(const render::SceneView& scene, const State& state) {
  const Model& model = *scene.model;
  const render::Bounds bounds = render::rest_bounds(scene);
  const Box around = Box(bounds.min, bounds.max).grown(kGone * bounds.diagonal());
  std::vector<Vec3> walls, position;
  contact::DrawnSurfaces drawn(model);
  for (std::size_t organ = 0; organ < model.surfaces.size(); ++organ) {
    if (model.surfaces[organ].triangle.empty()) continue;
    render::CutSurface cut(model, organ);
    cut.update(state);
    drawn.place(organ, cut.surface(), state, position);
    std::copy_if(position.begin() + std::ptrdiff_t(cut.outer_vertex_count()), position.end(), std::back_inserter(walls),
                 [&](Vec3 p) { return around.meets(Box(p)); });
  }
  return walls;
}

/// Around the organs and above the ground, and the usual direction first.
std::vector<Vec3> directions(const Model& model, const Camera& usual) {
  constexpr int kAround = 12;
  constexpr std::array kHeights{22.0, 42.0, 62.0};  // [degrees]
  const Vec3 up = render::up_of(model);
  Vec3 side = cross(std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, up);
  side = side / norm(side);
  std::vector<Vec3> found{(usual.target - usual.eye) / norm(usual.target - usual.eye)};
  for (const double height : kHeights)
    for (int k = 0; k < kAround; ++k) {
      const double a = 2 * std::numbers::pi * k / kAround, h = height * std::numbers::pi / 180;
      found.push_back(-(std::cos(h) * (std::cos(a) * side + std::sin(a) * cross(up, side)) + std::sin(h) * up));
    }
  return found;
}

/// Pixels that show walls and lips of cuts, which are green on grey organs.
int visible_wound(render::Renderer& renderer, const State& state, const Camera& camera) {
  render::DrawOptions options;
  options.camera = camera, options.show_ground = options.show_tool = false;
  const render::Frame frame = renderer.draw(state, options);
  int count = 0;
  for (std::size_t i = 0; i < frame.rgb.size(); i += 3)
    count += frame.rgb[i + 1] > frame.rgb[i] + 25 && frame.rgb[i + 1] > frame.rgb[i + 2] + 25;
  return count;
}

/// The wound, and of the organs what lies around it: at least a part of their size.
std::vector<Vec3> framed(const render::SceneView& scene, const std::vector<Vec3>& walls, double aspect) {
  const double around = aspect < 1.4 ? 0.8 : 0.62;  // of the organs' diagonal; a narrow picture has no room aside
  const render::Bounds organs = render::rest_bounds(scene);
  const Vec3 middle = render::bounds_of(walls).centre();
  const double reach = 0.5 * around * organs.diagonal();
  std::vector<Vec3> points = walls;
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    for (const double sign : {-1.0, 1.0}) points.push_back(middle + sign * reach * axis);
  return points;
}

}  // namespace

Result<std::optional<Camera>> wound_camera(const render::SceneView& scene, const State& state, const Camera& usual,
                                           double aspect) {
  constexpr int kWidth = 224, kHeight = 126;
  constexpr double kUsualCounts = 0.5;  // what is seen from the other side counts so much less
  if (state.swept.size() == 0) return std::optional<Camera>();
  const std::vector<Vec3> walls = walls_of(scene, state);
  if (walls.empty()) return std::optional<Camera>();
  render::SceneView plain{scene.model, {}, {}};
  for (const OrganRange& organ : scene.model->organs)
    plain.looks.push_back({organ.name, {0.25, 0.25, 0.25}, {0, 0.9, 0}, 0, {}});
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(kWidth, kHeight, plain);
  if (!renderer) return renderer.errors();
  const std::vector<Vec3> ways = directions(*scene.model, usual), points = framed(scene, walls, aspect);
  const Vec3 up = render::up_of(*scene.model);
  double best = 0;
  std::optional<Camera> found;
  for (const Vec3& way : ways) {
    const Camera whole = render::fitted_camera(scene, way, up, usual.fov_deg, double(kWidth) / kHeight);
    const double likeness = 0.5 + 0.5 * dot(way, ways.front());
    const double score = visible_wound(**renderer, state, whole) * (1 - kUsualCounts * (1 - likeness));
    if (score > best)
      best = score, found = render::fit_camera(std::span<const Vec3>(points), way, up, usual.fov_deg, aspect);
  }
  return found;
}

}  // namespace ctpm::views
