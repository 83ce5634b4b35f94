#include "core/surface/obstacle_shape.h"

#include <cmath>
#include <limits>

namespace ctpm::surface {
namespace {

Vec3 in_world(const Obstacle& obstacle, Vec3 point) {
  return obstacle.position + rotate(obstacle.world_from_obstacle, point);
}

Box bounds_of_box(const Obstacle& box) {
  Box bounds(box.position);
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0})
        bounds.add(in_world(box, {x * box.half_size.x, y * box.half_size.y, z * box.half_size.z}));
  return bounds;
}

RigidMesh mesh_of(const Obstacle& obstacle) {
  std::vector<Vec3> vertex;
  for (std::size_t i = 0; i < obstacle.vertex.size(); ++i) vertex.push_back(in_world(obstacle, obstacle.vertex[i]));
  std::vector<RigidMesh::Triangle> triangle;
  for (std::size_t i = 0; i + 2 < obstacle.corner.size(); i += 3)
    triangle.push_back({obstacle.corner[i], obstacle.corner[i + 1], obstacle.corner[i + 2]});
  return RigidMesh(std::move(vertex), triangle);
}

}  // namespace

ObstacleShape::ObstacleShape(const Obstacle& obstacle)
    : kind_(obstacle.kind),
      position_(obstacle.position),
      world_from_obstacle_(obstacle.world_from_obstacle),
      half_size_(obstacle.half_size),
      half_space_{obstacle.position, rotate(obstacle.world_from_obstacle, {0, 0, 1})},
      bounds_(bounds_of_box(obstacle)) {
  if (kind_ != ObstacleKind::mesh) return;
  mesh_ = mesh_of(obstacle);
  if (!mesh_.empty()) bounds_ = mesh_.box();
}

Inside ObstacleShape::inside(Vec3 point) const {
  if (kind_ == ObstacleKind::box) return inside_box(point);
  if (kind_ == ObstacleKind::mesh)
    return mesh_.empty() ? Inside{-std::numeric_limits<double>::infinity(), {0, 0, 1}} : mesh_.inside(point);
  return {-dot(point - half_space_.point, half_space_.normal), half_space_.normal};
}

bool ObstacleShape::meets(const Box& box) const { return clearance(box) <= 0; }

double ObstacleShape::clearance(const Box& box) const {
  const Vec3 centre = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low), normal = half_space_.normal;
  if (kind_ == ObstacleKind::plane)
    return -inside(centre).depth -
           (std::abs(normal.x) * half.x + std::abs(normal.y) * half.y + std::abs(normal.z) * half.z);
  if (const double apart = gap(bounds_, box); apart > 0) return apart;
  // No point of the box is farther from its centre than a corner.
  return -inside(centre).depth - norm(half);
}

Inside ObstacleShape::inside_box(Vec3 point) const {
  const Quat q = world_from_obstacle_;
  const Vec3 local = rotate({q.w, -q.x, -q.y, -q.z}, point - position_);
  const double at[3] = {local.x, local.y, local.z}, half[3] = {half_size_.x, half_size_.y, half_size_.z};
  Vec3 beyond;  // from the nearest point of the box
  double* const beyond_along[3] = {&beyond.x, &beyond.y, &beyond.z};
  std::size_t nearest = 0;
  const auto depth = [&](std::size_t axis) { return half[axis] - std::abs(at[axis]); };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (depth(axis) < depth(nearest)) nearest = axis;
    if (depth(axis) < 0) *beyond_along[axis] = at[axis] < 0 ? depth(axis) : -depth(axis);
  }
  if (const double away = norm(beyond); away > 0) return {-away, rotate(world_from_obstacle_, beyond / away)};
  const double sign = at[nearest] < 0 ? -1 : 1;
  const Vec3 axes[3] = {{sign, 0, 0}, {0, sign, 0}, {0, 0, sign}};
  return {depth(nearest), rotate(world_from_obstacle_, axes[nearest])};
}

}  // namespace ctpm::surface
