#include "core/surface/inside.h"

#include <cmath>

namespace ctpm::surface {
namespace {

Vec3 in_frame(const Obstacle& obstacle, Vec3 point) {
  const Quat q = obstacle.world_from_obstacle;
  return rotate({q.w, -q.x, -q.y, -q.z}, point - obstacle.position);
}

Inside inside_box(const Obstacle& box, Vec3 point) {
  const Vec3 local = in_frame(box, point);
  const double at[3] = {local.x, local.y, local.z}, half[3] = {box.half_size.x, box.half_size.y, box.half_size.z};
  Vec3 beyond;  // from the nearest point of the box
  double* const beyond_along[3] = {&beyond.x, &beyond.y, &beyond.z};
  std::size_t nearest = 0;
  const auto depth = [&](std::size_t axis) { return half[axis] - std::abs(at[axis]); };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (depth(axis) < depth(nearest)) nearest = axis;
    if (depth(axis) < 0) *beyond_along[axis] = at[axis] < 0 ? depth(axis) : -depth(axis);
  }
  if (const double away = norm(beyond); away > 0) return {-away, rotate(box.world_from_obstacle, beyond / away)};
  const double sign = at[nearest] < 0 ? -1 : 1;
  const Vec3 axes[3] = {{sign, 0, 0}, {0, sign, 0}, {0, 0, sign}};
  return {depth(nearest), rotate(box.world_from_obstacle, axes[nearest])};
}

}  // namespace

Inside find_inside(const Obstacle& obstacle, Vec3 point) {
  if (obstacle.kind == ObstacleKind::box) return inside_box(obstacle, point);
  const Vec3 normal = rotate(obstacle.world_from_obstacle, {0, 0, 1});
  return {-dot(point - obstacle.position, normal), normal};
}

}  // namespace ctpm::surface
