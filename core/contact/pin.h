#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/model/model.h"

namespace ctpm::contact {

/// The kinematic contact of a pin in one step: its sphere follows the hand exactly.
struct Pin {
  std::int32_t sphere = -1;  ///< -1: no pin is held
  Vec3 velocity{};           ///< brings the sphere to the hand at the end of the step [m/s]

  bool is_held() const { return sphere >= 0; }
  std::size_t index() const { return std::size_t(sphere); }
};

/// Those of both hands, which hold different spheres.
using Pins = std::array<Pin, kMostHands>;

inline bool any_held(const Pins& pins) { return pins[0].is_held() || pins[1].is_held(); }

/// Model::held_axes, with the spheres of the pins anchored.
inline std::uint8_t held_axes(const Pins& pins, const Model& model, std::size_t i) {
  const auto sphere = std::int32_t(i);
  return pins[0].sphere == sphere || pins[1].sphere == sphere ? kAnchored : model.held_axes[i];
}

}  // namespace ctpm::contact
