#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/network/network.h"
#include "scenes/scene_spec.h"

namespace ctpm::scenes {

/// A tissue of the paper (Bao & Wu, section 5.1).
struct MaterialPreset {
  const char* name;            ///< as it is written in scenes
  const char* organ;           ///< "liver", "kidney" or "skin"
  double sphere_radius;        ///< r that the moduli were calibrated with [m]
  double ball_radius;          ///< R of the paper's rigid ball [m]
  network::Material material;  ///< moduli [Pa/m], viscosity [Pa s/m], calibration area and spacing
  double usual_size_least;     ///< diagonal of such an organ's bounding box, human, smallest usual [m]
  double usual_size_most;      ///< largest usual [m]
  double damage_depth;         ///< [m]; 0: none is known. Liver: 12 mm (Schwartz et al. 2005)
  const char* source;          ///< where the values come from
};

/// All presets: each organ with the viscosity in kPa s/mm, and with the paper's own Pa s reading as
/// NAME-pa-s.
std::span<const MaterialPreset> material_presets();

/// The preset of that name; null if there is none.
const MaterialPreset* find_preset(std::string_view name);

/// Names of all presets, for messages.
std::vector<std::string> preset_names();

/// Moduli of a material: the spec's own values, and the preset's for the others. `missing` names the values that
/// neither gives.
struct ResolvedMaterial {
  network::Material material;
  std::vector<std::string> missing;  ///< keys that must be written; empty if the material is whole
};
ResolvedMaterial resolve_material(const MaterialSpec& spec);

}  // namespace ctpm::scenes
