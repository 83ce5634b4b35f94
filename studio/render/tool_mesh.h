#pragma once

#include <cstdint>
#include <vector>

#include "core/model/model.h"

namespace ctpm::render {

/// What one part of a tool is made of.
enum class ToolPart : std::int32_t { steel = 0, handle = 1 };

/// A tool in its own frame [m]: floats of one vertex are position, normal, part.
struct ToolMesh {
  std::vector<float> vertex;         ///< (vertex_count x 7)
  std::vector<std::uint32_t> index;  ///< (3 triangle_count)
};

/// A ball: the ball at the origin and a rod along +z that holds it. A scalpel: the blade's edge from the
/// origin along +z, its back towards -x, so that it cuts ahead towards +x, and a handle beyond the blade
/// along +z.
ToolMesh make_tool_mesh(const Tool& tool);

}  // namespace ctpm::render
