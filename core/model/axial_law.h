#pragma once

#include <cstdint>

namespace ctpm {

/// Force law of an axial element. Sessions store the numbers: none ever gets another meaning. This header has no
/// functions, so that the inner loops can include it.
enum class AxialLaw : std::int32_t {
  spring = 0,          ///< k (length - rest_length)
  kelvin_unit = 1,     ///< spring parallel to a dashpot: k (length - rest_length) + c d length / dt
  two_sphere_tpm = 2,  ///< spring k in series with a Kelvin unit of kelvin_k and c (K2, K1, v1 of the paper), whose
                       ///< elongation is an internal variable
};

}  // namespace ctpm
