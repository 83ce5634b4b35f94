#pragma once

#include <cstddef>
#include <cstdint>

#include "core/model/vec3.h"

namespace ctpm {

/// Hands that can hold a tool at once.
inline constexpr std::size_t kMostHands = 2;

/// What one hand does in a tick: which tool it holds, its pose and its buttons.
struct Hand {
  std::int32_t tool = -1;     ///< index into Model::tools; -1: the hand is empty
  Vec3 position;              ///< of the tool frame's origin in the world [m]
  Quat world_from_tool;       ///< orientation of the tool, unit length
  std::uint32_t buttons = 0;  ///< bit set, as the device reports it

  friend bool operator==(const Hand&, const Hand&) = default;
};

/// Input of one tick: the first hand, and the second one where the scene has two (Model::hands).
struct Inputs : Hand {
  Hand second;

  Hand& hand(std::size_t number) { return number == 0 ? *this : second; }
  const Hand& hand(std::size_t number) const { return number == 0 ? *this : second; }

  friend bool operator==(const Inputs&, const Inputs&) = default;
};

}  // namespace ctpm
