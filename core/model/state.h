#pragma once

#include <cstdint>
#include <vector>

#include "core/model/inputs.h"
#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm {

/// All that is needed to go on bit for bit. The velocity is also the warm start of the implicit solve.
struct State {
  std::int64_t tick = 0;   ///< ticks done
  Vec3Array position;      ///< [m]                                     (sphere_count)
  Vec3Array velocity;      ///< [m/s]                                   (sphere_count)
  Vec3Array acceleration;  ///< [m/s^2], from which sdirk2 guesses; empty for other integrators (sphere_count)
  std::vector<double> kelvin_elongation;         ///< internal variable of two-sphere TPMs [m]   (internal_count)
  std::vector<std::uint8_t> axial_severed;       ///< 1: severed; empty if the scene has no scalpel (axial_count)
  std::vector<std::uint8_t> constraint_severed;  ///< as above                                   (constraint_count)
  std::vector<std::uint8_t> angle_severed;       ///< as above                                      (angle_count)
  std::vector<std::uint8_t> axial_crossing;      ///< where the blade passed a severed element (stored_crossing); 0:
                                                 ///< not severed; empty if the scene has no scalpel (axial_count)
  Vec3Array blade_trail;                         ///< points towed behind a blade's tip and heel, from which its
                                                 ///< heading is known [m]; empty if the scene has no scalpel (2)
  Inputs last_inputs;                            ///< of the tick before, where a blade's sweep begins
};

/// The state at rest: rest positions, no motion, nothing severed, no tool.
State rest_state(const Model& model);

}  // namespace ctpm
