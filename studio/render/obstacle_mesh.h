#pragma once

#include <cstddef>
#include <optional>

#include "core/model/model.h"
#include "core/model/vec3.h"
#include "studio/render/tool_mesh.h"

namespace ctpm::render {

/// Whether an obstacle is a plane across `up`; it is not drawn, but is the ground on which shadows fall.
bool is_level_ground(const Obstacle& obstacle, Vec3 up);

/// A level face of a box that looks up, on which shadows fall: centre and half sides [m].
struct LevelTop {
  Vec3 centre, x, y;
};
std::optional<LevelTop> level_top_of(const Obstacle& obstacle, Vec3 up);

/// An obstacle as it is drawn, in the world. Of a plane, a square around the place below `centre` [m] with sides of
/// `size` [m]. A level top comes first, divided so finely that its vertices can carry a shadow: `top_vertices` of them.
struct ObstacleMesh {
  ToolMesh mesh;
  std::size_t top_vertices = 0;
};
ObstacleMesh make_obstacle_mesh(const Obstacle& obstacle, Vec3 up, Vec3 centre, double size);

}  // namespace ctpm::render
