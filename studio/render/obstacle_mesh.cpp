#include "studio/render/obstacle_mesh.h"

#include <cmath>

namespace ctpm::render {
namespace {

/// Adds the rectangle around `centre` with the half sides `u` and `v`; its normal is that of u x v.
void add_rectangle(ToolMesh& mesh, Vec3 centre, Vec3 u, Vec3 v) {
  const Vec3 across = cross(u, v), normal = across / norm(across);
  const auto first = std::uint32_t(mesh.vertex.size() / 7);
  for (const Vec3 p : {centre - u - v, centre + u - v, centre + u + v, centre - u + v})
    for (const double x : {p.x, p.y, p.z, normal.x, normal.y, normal.z, double(ToolPart::cloth)})
      mesh.vertex.push_back(float(x));
  mesh.index.insert(mesh.index.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
}

Vec3 normal_of(const Obstacle& plane) { return rotate(plane.world_from_obstacle, {0, 0, 1}); }

}  // namespace

bool is_level_ground(const Obstacle& obstacle, Vec3 up) {
  constexpr double kLevel = 1 - 1e-9;
  return obstacle.kind == ObstacleKind::plane && dot(normal_of(obstacle), up) > kLevel;
}

ToolMesh make_obstacle_mesh(const Obstacle& obstacle, Vec3 centre, double size) {
  ToolMesh mesh;
  const auto turned = [&](Vec3 v) { return rotate(obstacle.world_from_obstacle, v); };
  if (obstacle.kind == ObstacleKind::plane) {
    const Vec3 normal = normal_of(obstacle), below = centre - dot(centre - obstacle.position, normal) * normal;
    add_rectangle(mesh, below, turned({0.5 * size, 0, 0}), turned({0, 0.5 * size, 0}));
    return mesh;
  }
  const Vec3 x = turned({obstacle.half_size.x, 0, 0}), y = turned({0, obstacle.half_size.y, 0}),
             z = turned({0, 0, obstacle.half_size.z}), at = obstacle.position;
  add_rectangle(mesh, at + x, y, z), add_rectangle(mesh, at - x, z, y);
  add_rectangle(mesh, at + y, z, x), add_rectangle(mesh, at - y, x, z);
  add_rectangle(mesh, at + z, x, y), add_rectangle(mesh, at - z, y, x);
  return mesh;
}

}  // namespace ctpm::render
