#include "studio/server/hand_limits.h"

#include <algorithm>

#include "studio/compare/session_measures.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::server {
namespace {

constexpr double kTimes = 2;       ///< the limits at which tissue counts as damaged
constexpr double kOtherwise = 15;  ///< more than the scripts that ship press and cut with (14.6 N)
constexpr double kCounts = 0.1;    ///< share of the spheres from which on an organ counts: a stone in a kidney does not

/// Least extent of an organ at rest [m]. Half a spacing of its spheres stands out of it on each side.
double thickness_of(const Model& model, const OrganRange& organ) {
  const auto extent = [&](const std::vector<double>& along) {
    const auto first = along.begin() + organ.first;
    const auto [least, most] = std::minmax_element(first, first + organ.count);
    return *most - *least;
  };
  const Vec3Array& rest = model.rest_position;
  return std::max(organ.spacing, std::min({extent(rest.x), extent(rest.y), extent(rest.z)}) - organ.spacing);
}

}  // namespace

HandLimits limits_of_hand(const scenes::SceneSpec& scene, const Model& model) {
  const double force = loading::damage_force_of(scene), depth = compare::damage_depth_of(model);
  HandLimits limits{force > 0 ? kTimes * force : kOtherwise, kTimes * depth};
  if (depth > 0) return limits;
  for (const OrganRange& organ : model.organs) {
    if (organ.count < kCounts * double(model.sphere_count())) continue;
    const double half = thickness_of(model, organ) / 2;
    if (limits.depth_m == 0 || half < limits.depth_m) limits.depth_m = half;
  }
  return limits;
}

}  // namespace ctpm::server
