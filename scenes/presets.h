#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/network/network.h"
#include "scenes/scene_spec.h"

namespace ctpm::scenes {

/// The preset for tissue of no named organ.
inline constexpr const char* kGenericPreset = "soft-tissue";

/// A tissue of the paper (Bao & Wu, section 5.1), or one that is known by its Young's modulus.
struct MaterialPreset {
  const char* name;            ///< as it is written in scenes
  const char* organ;           ///< "liver", "kidney", ...
  double sphere_radius;        ///< r that the moduli were calibrated with [m]
  double ball_radius;          ///< R of the paper's rigid ball [m]
  network::Material material;  ///< moduli [Pa/m], viscosity [Pa s/m], calibration area and spacing
  double usual_size_least;     ///< diagonal of such an organ's bounding box, human, smallest usual [m]
  double usual_size_most;      ///< largest usual [m]
  double damage_depth;         ///< [m]; 0: none is known. Liver: 12 mm (Schwartz et al. 2005)
  const char* source;          ///< where the values come from
  bool is_of_paper = true;     ///< the paper's Table 1 has its forces

  /// What the living organ is under.
  struct InSitu {
    double pressure = 0;  ///< that its capsule holds [Pa]; 0: none is known
    double strain = 0;    ///< of its surface [1]; 0: none is known
    const char* source = "";
  } in_situ{};
};

/// All presets: each organ of the paper with the viscosity in kPa s/mm, and with the paper's own Pa s reading as
/// NAME-pa-s; other tissues.
std::span<const MaterialPreset> material_presets();

/// The preset of that name; null if there is none.
const MaterialPreset* find_preset(std::string_view name);

/// The first preset whose organ a name contains, upper or lower case ("Left kidney.stl"); null: it names none.
const MaterialPreset* preset_in_name(std::string_view name);

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
