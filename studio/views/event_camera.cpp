#include "studio/views/event_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/contact/drawn_surfaces.h"
#include "core/model/box.h"
#include "studio/render/cut_surface.h"
#include "studio/render/renderer.h"

namespace ctpm::views {
namespace {

using render::Camera;

/// An event where a camera can look for it: all of it is green, and everything else is grey.
struct Subject {
  render::SceneView scene;
  render::View view = render::View::surface;
  std::vector<Vec3> points;  ///< its places [m]; empty: there is no such event
  std::vector<Vec3> organs;  ///< of those that it happens to, at rest [m]
  std::vector<Vec3> pieces;  ///< see EventCamera
};

/// Walls farther from the organs at rest than this part of their size are those of pieces that fell or flew away.
constexpr double kGone = 0.5;
/// Tissue that has moved farther than this part of that size lies beside its organ.
constexpr double kBeside = 0.2;

void append(std::vector<Vec3>& all, const std::vector<Vec3>& more) { all.insert(all.end(), more.begin(), more.end()); }

/// Finds where the walls of all cuts are, without those of pieces that are gone. The cuts are kept for the Renderer.
void find_walls(const State& state, Subject& subject) {
  const Model& model = *subject.scene.model;
  const render::Bounds bounds = render::rest_bounds(subject.scene);
  const Box around = Box(bounds.min, bounds.max).grown(kGone * bounds.diagonal());
  std::vector<Vec3> position;
  contact::DrawnSurfaces drawn(model);
  subject.scene.cuts = std::make_shared<std::vector<render::CutSurface>>();
  for (std::size_t organ = 0; organ < model.surfaces.size(); ++organ) {
    render::CutSurface& cut = subject.scene.cuts->emplace_back(model, organ);
    if (model.surfaces[organ].triangle.empty()) continue;
    cut.update(state);
    drawn.place(organ, cut.surface(), state, position);
    const std::size_t before = subject.points.size();
    std::copy_if(position.begin() + std::ptrdiff_t(cut.outer_vertex_count()), position.end(),
                 std::back_inserter(subject.points), [&](Vec3 p) { return around.meets(Box(p)); });
    if (subject.points.size() == before) continue;
    append(subject.organs, model.surfaces[organ].vertex);
    for (std::size_t v = 0; v < cut.outer_vertex_count(); ++v) {
      const bool has_moved = norm(position[v] - cut.surface().vertex[v]) > kBeside * bounds.diagonal();
      if (has_moved && around.meets(Box(position[v]))) subject.pieces.push_back(position[v]);
    }
  }
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

constexpr render::Colour kGrey{0.25, 0.25, 0.25}, kGreen{0, 0.9, 0};

/// Walls and lips of cuts.
Subject wound_of(const render::SceneView& scene, const State& state) {
  Subject subject{{scene.model, {}, {}}, render::View::surface, {}, {}, {}};
  if (state.swept.size() == 0) return subject;
  for (const OrganRange& organ : scene.model->organs) subject.scene.looks.push_back({organ.name, kGrey, kGreen, 0, {}});
  find_walls(state, subject);
  return subject;
}

/// Spheres of the outermost layer around the tools.
Subject press_of(const render::SceneView& scene, const State& state) {
  constexpr double kAround = 1.5;  // spacings of the organ beyond a tool's surface
  const Model& model = *scene.model;
  Subject subject{{&model, {}, {}}, render::View::spheres, {}, {}, {}};
  subject.scene.sphere_colours.assign(state.position.size(), kGrey);
  for (std::size_t number = 0; number < kMostHands; ++number) {
    const Hand& hand = state.last_inputs.hand(number);
    if (hand.tool < 0 || model.tools[std::size_t(hand.tool)].kind == ToolKind::scalpel) continue;
    for (std::size_t o = 0; o < model.organs.size(); ++o) {
      const OrganRange& organ = model.organs[o];
      const std::size_t before = subject.points.size();
      for (auto i = std::size_t(organ.first); i < std::size_t(organ.first + organ.count); ++i) {
        const double reach = model.tools[std::size_t(hand.tool)].radius + kAround * organ.spacing;
        if (model.layer[i] != 1 || norm(state.position[i] - hand.position) > reach) continue;
        subject.scene.sphere_colours[i] = kGreen;
        subject.points.push_back(state.position[i]);
      }
      if (subject.points.size() > before) append(subject.organs, model.surfaces[o].vertex);
    }
  }
  return subject;
}

/// The area of the subject that is seen from the camera's eye, whose picture it fills as far as it may [m^2 of the
/// plane across the sight, times a constant].
double visible(render::Renderer& renderer, const Subject& subject, const State& state, Camera camera) {
  const render::Bounds bounds = render::bounds_of(subject.points);
  const double distance = norm(camera.eye - camera.target), radius = 0.5 * bounds.diagonal();
  const double high = std::tan(camera.fov_deg * std::numbers::pi / 360), needed = 1.2 * radius / distance;
  camera.fov_deg = std::atan(std::min(high, needed)) * 360 / std::numbers::pi;
  render::DrawOptions options;
  options.camera = camera, options.view = subject.view, options.show_ground = false;
  options.show_tool = subject.view == render::View::spheres;  // a blade that stays in its cut covers it
  const render::Frame frame = renderer.draw(state, options);
  int count = 0;
  for (std::size_t i = 0; i < frame.rgb.size(); i += 3)
    count += frame.rgb[i + 1] > frame.rgb[i] + 25 && frame.rgb[i + 1] > frame.rgb[i + 2] + 25;
  const double side = distance * std::min(high, needed);
  return count * side * side;
}

/// The part of the points that is in the picture.
double share_in_picture(const Camera& camera, double aspect, const std::vector<Vec3>& points) {
  constexpr int kHigh = 1000;
  const int wide = int(aspect * kHigh);
  const auto is_in = [&](Vec3 point) {
    const render::Pixel p = render::project(camera, wide, kHigh, point);
    return p.depth > 0 && p.x >= 0 && p.x < wide && p.y >= 0 && p.y < kHigh;
  };
  return points.empty() ? 1 : double(std::count_if(points.begin(), points.end(), is_in)) / double(points.size());
}

/// The event, and of the organs what lies around it: at least a part of their size.
std::vector<Vec3> framed(const render::SceneView& scene, const std::vector<Vec3>& event, double aspect) {
  const double around = aspect < 1.4 ? 0.8 : 0.62;  // of the organs' diagonal; a narrow picture has no room aside
  const render::Bounds organs = render::rest_bounds(scene);
  const Vec3 middle = render::bounds_of(event).centre();
  const double reach = 0.5 * around * organs.diagonal();
  std::vector<Vec3> points = event;
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    for (const double sign : {-1.0, 1.0}) points.push_back(middle + sign * reach * axis);
  return points;
}

}  // namespace

Result<std::optional<EventCamera>> event_camera(Event event, const render::SceneView& scene, const State& state,
                                                const Camera& usual, double aspect) {
  constexpr int kWidth = 224, kHeight = 126;
  constexpr double kUsualCounts = 0.5;  // what is seen from the other side counts so much less
  constexpr int kWhole = 4;             // power of the part of the organ in the picture
  constexpr double kFarther = 1.3;      // so much farther it stands where that shows the whole organ
  Subject subject = event == Event::wound ? wound_of(scene, state) : press_of(scene, state);
  if (subject.points.empty()) return std::optional<EventCamera>();
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(kWidth, kHeight, subject.scene);
  if (!renderer) return renderer.errors();
  const std::vector<Vec3> ways = directions(*scene.model, usual), points = framed(scene, subject.points, aspect);
  std::vector<Vec3> whole = points;
  append(whole, subject.organs);
  const Vec3 up = render::up_of(*scene.model);
  double best = 0;
  std::optional<Camera> found;
  for (const Vec3& way : ways) {
    const auto fitted = [&](const std::vector<Vec3>& shown) {
      return render::fit_camera(std::span<const Vec3>(shown), way, up, usual.fov_deg, aspect);
    };
    Camera camera = fitted(points);
    if (const Camera farther = fitted(whole);
        norm(farther.eye - farther.target) < kFarther * norm(camera.eye - camera.target))
      camera = farther;
    const double likeness = 0.5 + 0.5 * dot(way, ways.front());
    const double in_picture = share_in_picture(camera, aspect, subject.organs);
    const double score = visible(**renderer, subject, state, camera) * (1 - kUsualCounts * (1 - likeness)) *
                         std::pow(in_picture, kWhole);
    if (score > best) best = score, found = camera;
  }
  if (!found) return std::optional<EventCamera>();
  return std::optional<EventCamera>({*found, std::move(subject.pieces)});
}

}  // namespace ctpm::views
