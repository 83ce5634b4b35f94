#include "studio/views/scene_marks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scenes/build_model.h"
#include "studio/views/view_of_scene.h"

namespace ctpm::views {
namespace {

using render::Mark;

constexpr render::Colour kAnchor{0.55, 0.60, 0.66}, kProbe{1.0, 0.85, 0.25}, kTool{0.35, 0.90, 0.95},
    kLoad{0.95, 0.45, 0.85}, kWay{1.0, 1.0, 1.0}, kZone{1.0, 0.42, 0.36};

/// A closed line.
Mark ring_of(Vec3 centre, Vec3 x, Vec3 y, int corners) {
  Mark ring{Mark::Shape::line, {}, kZone, ""};
  for (int i = 0; i <= corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / corners;
    ring.points.push_back(centre + std::cos(angle) * x + std::sin(angle) * y);
  }
  return ring;
}

/// The outline of a forbidden zone: three circles, four sides of a box, or a square of a plane, `size` wide.
void add_zone(const scenes::ZoneSpec& zone, double size, std::vector<Mark>& marks) {
  const std::size_t first = marks.size();
  if (zone.sphere) {
    const double r = zone.sphere->radius;
    const Vec3 x{r, 0, 0}, y{0, r, 0}, z{0, 0, r};
    for (const auto& [a, b] : {std::pair{x, y}, {y, z}, {z, x}})
      marks.push_back(ring_of(zone.sphere->centre, a, b, 48));
  } else if (zone.box) {
    const Vec3 middle = 0.5 * (zone.box->min + zone.box->max), half = zone.box->max - middle;
    // A ring of four corners has its sides at 1 / sqrt(2) of its radius.
    const double corner = std::numbers::sqrt2;
    const Vec3 x{corner * half.x, 0, 0}, y{0, corner * half.y, 0}, z{0, 0, corner * half.z};
    for (const double side : {-1.0, 1.0}) {
      marks.push_back(ring_of(middle + Vec3{0, 0, side * half.z}, x, y, 4));
      marks.push_back(ring_of(middle + Vec3{0, side * half.y, 0}, x, z, 4));
    }
  } else if (zone.plane) {
    const Vec3 normal = zone.plane->normal / norm(zone.plane->normal);
    const Vec3 helper = std::abs(normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 x = cross(normal, helper) / norm(cross(normal, helper)), y = cross(normal, x);
    marks.push_back(ring_of(zone.plane->point, size * x, size * y, 4));
  }
  if (marks.size() > first) marks[first].label = zone.name;
}

/// The ways of a script's tools, a mark for each tool that is taken.
void add_ways(const scenes::Script& script, const Model& model, std::vector<Mark>& marks) {
  constexpr std::int64_t kMostPoints = 2000;
  const scenes::ScriptPlayer player(script, model.tools, model.tick);
  const std::int64_t every = std::max<std::int64_t>(1, player.tick_count() / kMostPoints);
  for (std::size_t hand = 0; hand < kMostHands; ++hand) {
    std::int32_t tool = -1;
    for (std::int64_t tick = 0; tick < player.tick_count(); tick += every) {
      const Inputs inputs = player.at(tick);
      const Hand& now = inputs.hand(hand);
      if (now.tool >= 0 && now.tool != tool)
        marks.push_back({Mark::Shape::line, {}, kWay, model.tools[std::size_t(now.tool)].name + "'s way"});
      if (now.tool >= 0) marks.back().points.push_back(now.position);
      tool = now.tool;
    }
  }
}

}  // namespace

std::vector<Mark> marks_of(const scenes::SceneSpec& scene, const Model& model, const State& state,
                           const std::optional<scenes::Script>& script) {
  const render::Bounds bounds = render::rest_bounds(view_of(scene, model));
  std::vector<Mark> marks = render::axes_of(bounds);
  Mark anchors{Mark::Shape::dot, {}, kAnchor, ""};
  for (std::size_t n = 0; n < model.sphere_count(); ++n)
    if ((model.held_axes[n] & 7) == 7) anchors.points.push_back(state.position[n]);
  if (!anchors.points.empty()) marks.push_back(anchors);
  for (const scenes::ProbeSpec& probe : scene.probes)
    marks.push_back({Mark::Shape::ring,
                     {state.position[std::size_t(scenes::nearest_sphere(model, probe.at))]},
                     kProbe,
                     probe.name});
  const double length = bounds.diagonal() / 10;
  for (const scenes::LoadSpec& load : scene.loads)
    if (norm(load.force) > 0)
      marks.push_back({Mark::Shape::arrow, {load.at - length / norm(load.force) * load.force, load.at}, kLoad, "load"});
  for (const scenes::ToolSpec& tool : scene.tools) {
    const std::optional<Vec3> at = tool.holds ? tool.holds : tool.at;
    if (!at) continue;
    const Vec3 pointing = tool.pointing.value_or(Vec3{0, 0, -1});
    marks.push_back({Mark::Shape::arrow, {*at - length / norm(pointing) * pointing, *at}, kTool, tool.name});
  }
  for (const scenes::ZoneSpec& zone : scene.forbidden) add_zone(zone, bounds.diagonal() / 2, marks);
  if (script) add_ways(*script, model, marks);
  return marks;
}

}  // namespace ctpm::views
