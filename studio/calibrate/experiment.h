#pragma once

#include <optional>
#include <vector>

#include "scenes/scene_spec.h"
#include "studio/calibrate/measurement.h"
#include "studio/loading/loaded_scene.h"

namespace ctpm::calibrate {

/// What is fitted. Tissue that has crept knows the first two alone.
struct Parameters {
  double slow = 0;        ///< P2 = K1 K2 / (K1 + K2) [kPa/mm]
  double constraint = 0;  ///< K' / P2 [1], >= 1
  double ratio = 0;       ///< K1 / K2 [1]
  double time = 0;        ///< P1 = v1 / (K1 + K2) [s]

  double kelvin() const { return slow * (1 + ratio); }               ///< K1 [kPa/mm]
  double spring() const { return slow * (1 + 1 / ratio); }           ///< K2 [kPa/mm]
  double prime() const { return constraint * slow; }                 ///< K' [kPa/mm]
  double viscosity() const { return time * (kelvin() + spring()); }  ///< v1 [kPa s/mm]
};

/// The parameters of a material's own moduli.
Parameters parameters_of(const scenes::MaterialSpec& material);
/// A material with these moduli, and all else as `material` has it.
scenes::MaterialSpec with_moduli(scenes::MaterialSpec material, const Parameters& parameters);

/// What a measurement would have found on the tissue of a scene, simulated in the network, at each of its rows [N] or
/// [mm]; none if a tick is refused. The scene has one organ, the paper's rig of five spheres (Fig. 3) or a block, and a
/// pin and a probe at the sphere that is pressed with the ball of `material`.
std::optional<std::vector<double>> simulate(const loading::LoadedScene& tissue, const scenes::MaterialSpec& material,
                                            const Measurement& measurement);

}  // namespace ctpm::calibrate
