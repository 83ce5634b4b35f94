#include "studio/loading/oddities.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/cutting/rest_map.h"
#include "core/cutting/tissue_depth.h"
#include "core/model/box.h"
#include "studio/loading/standing.h"

namespace ctpm::loading {
namespace {

std::string item(const char* list, std::size_t index) { return std::string(list) + "/" + std::to_string(index); }

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// A part of its size by which an organ as a whole may move before the first tick (our choice).
constexpr double kFarAway = 0.25;
/// Part of an organ's spheres that may lie in another one: scans of neighbours overlap a little (our choice).
constexpr double kOverlap = 0.02;

/// Distance from a point to the nearest sphere, and the spacing of that sphere's organ.
struct Near {
  double distance = INFINITY, spacing = 0;  ///< [m]
};
Near nearest(const Model& model, Vec3 point) {
  Near near;
  for (const OrganRange& range : model.organs)
    for (std::int32_t i = range.first; i < range.first + range.count; ++i)
      if (const double d = norm(model.rest_position[std::size_t(i)] - point); d < near.distance)
        near = {d, range.spacing};
  return near;
}

class Look {
 public:
  explicit Look(const LoadedScene& scene) : scene_(scene), model_(scene.built.model) {}

  void at_points() {
    const scenes::SceneSpec& spec = scene_.scene.spec;
    for (std::size_t i = 0; i < spec.probes.size(); ++i)
      look_at(item("/probes", i) + "/at_mm", spec.probes[i].at, "it would record the nearest sphere");
    for (std::size_t i = 0; i < spec.loads.size(); ++i)
      look_at(item("/loads", i) + "/at_mm", spec.loads[i].at, "the nearest tissue would be pulled");
    for (std::size_t i = 0; i < spec.cameras.size(); ++i) look_through(item("/cameras", i), spec.cameras[i]);
  }

  void at_thin_parts() {
    for (std::size_t i = 0; i < scene_.reports.size(); ++i)
      for (const importers::Finding& finding : scene_.reports[i].fill.findings)
        if (finding.code == "thin") warn(item("/organs", i) + "/fill", finding.found, finding.remains);
  }

  /// Organs that touch lie beside each other, and overlap by some spheres at most; more are tissue at the same place
  /// twice.
  void at_overlaps() {
    const std::size_t organs = model_.organs.size();
    std::vector<std::vector<std::int32_t>> inside(organs);
    for (std::size_t other = 0; other < organs; ++other) inside[other] = count_inside(other);
    for (std::size_t i = 0; i < organs; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const std::int32_t own = inside[j][i], other = inside[i][j];
        const double own_share = double(own) / model_.organs[i].count, share = double(other) / model_.organs[j].count;
        if (std::max(own_share, share) < kOverlap) continue;
        if (own_share >= share) warn_of_overlap(i, j, own);
        if (own_share < share) warn_of_overlap(j, i, other);
      }
  }

  void at_anchors(const Standing& standing) {
    const scenes::SceneSpec& spec = scene_.scene.spec;
    const bool can_rest = !spec.obstacles.empty() || spec.organs_meet;
    for (std::size_t i = 0; i < standing.organ.size(); ++i) {
      const OrganStanding& organ = standing.organ[i];
      if (spec.organs[i].rig) continue;
      const std::string at = item("/organs", i);
      if (organ.held == model_.organs[i].count)
        warn(at + "/anchors", "hold every sphere of the organ, so that nothing of it can move", "anchor less of it");
      else if (organ.held == 0 && norm(spec.gravity) > 0 && !can_rest)
        warn(at, "nothing holds the organ, so that it falls", "give it anchors, or an obstacle to rest on");
      else if (organ.way > kFarAway * organ.size)
        warn(
            at,
            "nothing holds the organ where it is: it moves by " + number(1e3 * organ.way) + " mm before the first tick",
            "give it anchors, or an obstacle right below it");
      else if (!organ.stands())
        warn(at,
             "sags by " + number(1e3 * organ.sag) + " mm under its weight, " + number(100 * organ.share()) +
                 " % of its size, before the first tick",
             "hold more of it, or take a stiffer material");
    }
    if (standing.is_refused) warn("/organs", "the scene cannot settle: the integrator gives up", "check its stiffness");
  }

  Errors warnings;

 private:
  /// Spheres of each organ that lie inside the surface of another one at rest, by 2.2 mm or more.
  std::vector<std::int32_t> count_inside(std::size_t other) {
    std::vector<std::int32_t> counts(model_.organs.size(), 0);
    if (other >= model_.surfaces.size() || model_.surfaces[other].triangle.empty()) return counts;
    Box box(model_.surfaces[other].vertex.front());
    for (const Vec3& vertex : model_.surfaces[other].vertex) box.add(vertex);
    // The depth of tissue takes time to make, and organs that lie beside each other need none.
    std::optional<cutting::RestMap> map;
    std::optional<cutting::TissueDepth> depth;
    for (std::size_t organ = 0; organ < counts.size(); ++organ) {
      const OrganRange& range = model_.organs[organ];
      for (std::int32_t i = range.first; organ != other && i < range.first + range.count; ++i) {
        const Vec3 p = model_.rest_position[std::size_t(i)];
        if (!box.meets(Box(p))) continue;
        if (!depth) depth.emplace(model_, map.emplace(model_), other);
        if (depth->at(other, p) >= cutting::TissueDepth::kBand) ++counts[organ];
      }
    }
    return counts;
  }

  void warn_of_overlap(std::size_t organ, std::size_t other, std::int32_t count) {
    const auto& organs = scene_.scene.spec.organs;
    warn(item("/organs", organ),
         "lies in " + organs[other].name + " with " + std::to_string(count) + " of its " +
             std::to_string(model_.organs[organ].count) + " spheres",
         "move it beside " + organs[other].name);
  }

  void warn(const std::string& at, const std::string& message, const std::string& hint) {
    warnings.push_back(scene_.scene.places.error_at(at, message, hint));
  }

  void look_at(const std::string& at, Vec3 point, const char* effect) {
    constexpr double kFar = 2;  // spacings
    const Near near = nearest(model_, point);
    if (near.distance <= kFar * near.spacing) return;
    warn(at, "lies " + number(1e3 * near.distance) + " mm from the nearest tissue", effect);
  }

  void look_through(const std::string& at, const scenes::CameraSpec& camera) {
    Vec3 least{INFINITY, INFINITY, INFINITY}, most = -1.0 * least;
    for (std::size_t i = 0; i < model_.sphere_count(); ++i) {
      const Vec3 p = model_.rest_position[i];
      least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
      most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
    const Vec3 to_middle = 0.5 * (least + most) - camera.eye, line = camera.target - camera.eye;
    const double radius = 0.5 * norm(most - least), distance = norm(to_middle);
    if (distance <= radius) return;
    // The widest angle of a picture of usual shape is that to its corner.
    constexpr double kCorner = 2.1;
    const double half = 0.5 * camera.field_of_view * std::numbers::pi / 180;
    const double off = std::acos(std::clamp(dot(to_middle, line) / (distance * norm(line)), -1.0, 1.0));
    if (off > std::atan(kCorner * std::tan(half)) + std::asin(radius / distance))
      warn(at, "does not look at any tissue", "the middle of the organs is at the other end of its target_mm");
    else if (radius / distance < 0.02 * std::tan(half))
      warn(at, "is so far away that the organs are a dot", "move its eye_mm nearer");
  }

  const LoadedScene& scene_;
  const Model& model_;
};

}  // namespace

Errors find_odd_places(const LoadedScene& scene) {
  Look look(scene);
  look.at_points(), look.at_thin_parts(), look.at_overlaps();
  return look.warnings;
}

Errors find_unsteady(const LoadedScene& scene, const State& settled) {
  Look look(scene);
  look.at_anchors({.organ = standing_of(scene.built.model, settled), .state = {}});
  return look.warnings;
}

std::optional<Errors> find_oddities(const LoadedScene& scene, const std::function<bool()>& should_stop) {
  Look look(scene);
  look.at_points(), look.at_thin_parts(), look.at_overlaps();
  const std::optional<Standing> standing = settle_scene(scene.scene.spec, scene.built.model, {}, should_stop);
  if (!standing) return std::nullopt;
  if (!standing->organ.empty()) look.at_anchors(*standing);
  return look.warnings;
}

}  // namespace ctpm::loading
