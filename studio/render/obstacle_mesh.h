#pragma once

#include "core/model/model.h"
#include "core/model/vec3.h"
#include "studio/render/tool_mesh.h"

namespace ctpm::render {

/// Whether an obstacle is a plane across `up`; it is not drawn, but is the ground on which shadows fall.
bool is_level_ground(const Obstacle& obstacle, Vec3 up);

/// An obstacle as it is drawn, in the world. Of a plane, a square around the place below `centre` [m] with sides of
/// `size` [m].
ToolMesh make_obstacle_mesh(const Obstacle& obstacle, Vec3 centre, double size);

}  // namespace ctpm::render
