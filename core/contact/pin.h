#pragma once

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

  /// Model::held_axes, with the sphere of the pin anchored.
  std::uint8_t held_axes(const Model& model, std::size_t i) const {
    return is_held() && i == index() ? kAnchored : model.held_axes[i];
  }
};

}  // namespace ctpm::contact
