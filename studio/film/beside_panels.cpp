#include "studio/film/beside_panels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace ctpm::film {
namespace {

constexpr int kSteps = 12;         // to each side
constexpr int kStepsBack = 4;      // where moving does not suffice
constexpr double kFarther = 0.09;  // for each of them, of the distance
constexpr double kLeastGainBack = 0.02;
constexpr double kStep = 0.02;           // of the picture's width
constexpr double kLeastGain = 0.002;     // for each further step, in shares of what is shown
constexpr double kMargin = 0.02;         // of the picture's width, between organs and its border
constexpr std::size_t kPoints = 1500;    // of the organs that are looked at
constexpr double kWeightOfTools = 0.25;  // panels fade before tools

/// The camera with which everything stands further right and up by these shares of the picture's width.
render::Camera moved(render::Camera camera, double right, double up, double aspect) {
  const Vec3 sight = camera.target - camera.eye, across = cross(sight, camera.up), above = cross(across, sight);
  const double width = 2 * norm(sight) * std::tan(camera.fov_deg * std::numbers::pi / 360) * aspect;
  const Vec3 back = -width * (right / norm(across) * across + up / norm(above) * above);
  camera.eye += back, camera.target += back;
  return camera;
}

/// The share of the points for which `is_lost` holds, of at most kPoints of them.
template <class IsLost>
double share_lost(std::span<const Vec3> points, IsLost&& is_lost) {
  const std::size_t stride = points.size() / kPoints + 1;
  std::size_t lost = 0, all = 0;
  for (std::size_t i = 0; i < points.size(); i += stride) ++all, lost += is_lost(points[i]);
  return all ? double(lost) / double(all) : 0.0;
}

}  // namespace

render::Camera beside_panels(const render::Camera& camera, const render::PictureSize& size,
                             std::span<const render::PixelBox> panels, const Shown& shown) {
  const double aspect = double(size.width) / size.height, margin = kMargin * size.width;
  const auto cost = [&](const render::Camera& moved) {
    const auto is_behind_panel = [&](const render::Pixel& p) {
      return std::any_of(panels.begin(), panels.end(), [&](const render::PixelBox& box) { return box.holds(p); });
    };
    const auto seen = [&](Vec3 point) { return render::project(moved, size.width, size.height, point); };
    const double organs = share_lost(shown.organs, [&](Vec3 point) {
      const render::Pixel p = seen(point);
      return p.x < margin || p.x > size.width - margin || p.y < margin || p.y > size.height - margin ||
             is_behind_panel(p);
    });
    return organs + kWeightOfTools * share_lost(shown.tools, [&](Vec3 point) { return is_behind_panel(seen(point)); });
  };
  render::Camera best = camera;
  double least = cost(camera);
  for (int back = 0; back <= kStepsBack; ++back) {
    render::Camera from = camera;
    from.eye = camera.target + (1 + kFarther * back) * (camera.eye - camera.target);
    // Along a diagonal the way is as long as both of its sides.
    for (const auto& [right, up] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}})
      for (int step = back > 0 ? 0 : 1; step <= kSteps; ++step) {
        const render::Camera there = moved(from, right * step * kStep, up * step * kStep, aspect);
        const double way = kLeastGainBack * back + kLeastGain * step * (std::abs(right) + std::abs(up));
        if (way < least)
          if (const double total = cost(there) + way; total < least) best = there, least = total;
      }
  }
  return best;
}

}  // namespace ctpm::film
