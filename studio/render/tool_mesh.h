#pragma once

#include <cstdint>
#include <vector>

#include "core/model/model.h"

namespace ctpm::render {

/// The material of one part of a tool, or of an obstacle.
enum class ToolPart : std::int32_t { steel = 0, handle = 1, cloth = 2 };

/// A tool in its own frame. The floats of a vertex are position [m], normal, part; for cloth, the part and how much
/// darker a shadow makes it, in [0, 1).
struct ToolMesh {
  std::vector<float> vertex;         ///< (vertex_count x 7)
  std::vector<std::uint32_t> index;  ///< (3 triangle_count)
};

/// A ball lies at the origin and is held by a rod along +z. A scalpel's edge runs from the origin along +z, its back
/// faces -x, it cuts towards +x, and its handle continues beyond the blade along +z.
ToolMesh make_tool_mesh(const Tool& tool);

}  // namespace ctpm::render
