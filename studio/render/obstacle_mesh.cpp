#include "studio/render/obstacle_mesh.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace ctpm::render {
namespace {

constexpr double kLevel = 1 - 1e-9;
constexpr int kPartsOfTop = 64;  ///< along each side

/// Adds the rectangle around `centre` with the half sides `u` and `v`, of `parts` squared equal parts; its normal is
/// that of u x v.
void add_rectangle(ToolMesh& mesh, Vec3 centre, Vec3 u, Vec3 v, int parts = 1) {
  const Vec3 across = cross(u, v), normal = across / norm(across);
  const auto first = std::uint32_t(mesh.vertex.size() / 7), row = std::uint32_t(parts + 1);
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; j <= parts; ++j) {
      const Vec3 p = centre + (2.0 * i / parts - 1) * u + (2.0 * j / parts - 1) * v;
      for (const double x : {p.x, p.y, p.z, normal.x, normal.y, normal.z, double(ToolPart::cloth)})
        mesh.vertex.push_back(float(x));
    }
  for (std::uint32_t i = 0; i + 1 < row; ++i)
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t a = first + i * row + j, b = a + row;
      mesh.index.insert(mesh.index.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
}

/// Adds a flat triangle; one without an area is left out.
void add_triangle(ToolMesh& mesh, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 across = cross(b - a, c - a);
  const double size = norm(across);
  if (!(size > 0)) return;
  const auto first = std::uint32_t(mesh.vertex.size() / 7);
  for (const Vec3 p : {a, b, c})
    for (const double x : {p.x, p.y, p.z, across.x / size, across.y / size, across.z / size, double(ToolPart::cloth)})
      mesh.vertex.push_back(float(x));
  mesh.index.insert(mesh.index.end(), {first, first + 1, first + 2});
}

Vec3 normal_of(const Obstacle& plane) { return rotate(plane.world_from_obstacle, {0, 0, 1}); }

/// Centre and half sides of the faces of a box, so that u x v looks outwards.
std::array<LevelTop, 6> faces_of(const Obstacle& box) {
  const auto turned = [&](Vec3 v) { return rotate(box.world_from_obstacle, v); };
  const Vec3 x = turned({box.half_size.x, 0, 0}), y = turned({0, box.half_size.y, 0}),
             z = turned({0, 0, box.half_size.z}), at = box.position;
  return {{{at + x, y, z}, {at - x, z, y}, {at + y, z, x}, {at - y, x, z}, {at + z, x, y}, {at - z, y, x}}};
}

bool looks_up(const LevelTop& face, Vec3 up) {
  const Vec3 across = cross(face.x, face.y);
  return dot(across, up) > kLevel * norm(across);
}

}  // namespace

bool is_level_ground(const Obstacle& obstacle, Vec3 up) {
  return obstacle.kind == ObstacleKind::plane && dot(normal_of(obstacle), up) > kLevel;
}

std::optional<LevelTop> level_top_of(const Obstacle& obstacle, Vec3 up) {
  if (obstacle.kind != ObstacleKind::box) return std::nullopt;
  for (const LevelTop& face : faces_of(obstacle))
    if (looks_up(face, up)) return face;
  return std::nullopt;
}

ObstacleMesh make_obstacle_mesh(const Obstacle& obstacle, Vec3 up, Vec3 centre, double size) {
  ObstacleMesh made;
  ToolMesh& mesh = made.mesh;
  const auto turned = [&](Vec3 v) { return rotate(obstacle.world_from_obstacle, v); };
  switch (obstacle.kind) {
    case ObstacleKind::plane: {
      const Vec3 normal = normal_of(obstacle), below = centre - dot(centre - obstacle.position, normal) * normal;
      add_rectangle(mesh, below, turned({0.5 * size, 0, 0}), turned({0, 0.5 * size, 0}));
      break;
    }
    case ObstacleKind::box: {
      if (const auto top = level_top_of(obstacle, up)) add_rectangle(mesh, top->centre, top->x, top->y, kPartsOfTop);
      made.top_vertices = mesh.vertex.size() / 7;
      for (const LevelTop& face : faces_of(obstacle))
        if (!looks_up(face, up)) add_rectangle(mesh, face.centre, face.x, face.y);
      break;
    }
    case ObstacleKind::mesh:
      for (std::size_t i = 0; i + 2 < obstacle.corner.size(); i += 3) {
        const auto corner = [&](std::size_t c) {
          return obstacle.position + turned(obstacle.vertex[std::size_t(obstacle.corner[i + c])]);
        };
        add_triangle(mesh, corner(0), corner(1), corner(2));
      }
      break;
  }
  return made;
}

}  // namespace ctpm::render
