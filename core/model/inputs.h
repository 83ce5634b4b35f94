#pragma once

#include <cstdint>

#include "core/model/vec3.h"

namespace ctpm {

/// Input of one tick: which tool is held, its pose and its buttons.
struct Inputs {
  std::int32_t tool = -1;     ///< index into Model::tools; -1: no tool in the scene
  Vec3 position;              ///< of the tool frame's origin in the world [m]
  Quat world_from_tool;       ///< orientation of the tool, unit length
  std::uint32_t buttons = 0;  ///< bit set, as the device reports it

  friend bool operator==(const Inputs&, const Inputs&) = default;
};

}  // namespace ctpm
