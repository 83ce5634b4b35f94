#include "scenes/presets.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace ctpm::scenes {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Bovine liver: 164 J/m^2 by needles (Gokgol, Basdogan & Canadinc, Med. Eng. Phys. 34, 2012); pig liver by blades 187
/// to 225, by needles in the living 76 to 185 (Liu et al., Chin. J. Mech. Eng. 35, 2022, Table 2). Kidney: none is
/// published; the liver's, an estimate. Skin: 1700 J/m^2 (Pereira, Lucas & Teaford, J. Biomech. 30, 1997, rat, by
/// scissors).
constexpr double kOrganToughness = 164, kSkinToughness = 1700;
/// Dynamic friction on a needle in bovine liver, 10.57 N per metre of a 1.65 mm wide needle (Okamura, Simone &
/// O'Leary, IEEE TBME 51, 2004), over its circumference; for all organs, an estimate.
constexpr double kBladeFriction = 2040;

/// What an organ's surface is under in the body.
constexpr MaterialPreset::InSitu kLiverInSitu{
    930, 0, "7 mmHg, of the normal 5 to 10 mmHg in the portal vein (estimate: what the capsule holds)"};
constexpr MaterialPreset::InSitu kKidneyInSitu{1060, 0,
                                               "10.8 cm of water below the capsule, dogs (doi 10.1007/BF00586833)"};
constexpr MaterialPreset::InSitu kSkinInSitu{
    0, 0.18, "excised skin of dogs shrinks by 33 % in area, so by 18 % in length (arXiv 1609.07267)"};

/// One row of the paper's section 5.1, in its own numbers: r and R [mm], K1, K2, K' [kPa/mm], v1.
constexpr MaterialPreset row(const char* name, const char* organ, double r, double ball, double k1, double k2,
                             double constraint, double viscosity_kpa_s_per_mm, double toughness, double least,
                             double most, double damage, const char* source, MaterialPreset::InSitu in_situ) {
  MaterialPreset preset{name, organ, r * 1e-3, ball * 1e-3, {}, least, most, damage, source, true, in_situ};
  network::Material& m = preset.material;
  m.kelvin = k1 * 1e6, m.spring = k2 * 1e6, m.constraint = constraint * 1e6, m.viscosity = viscosity_kpa_s_per_mm * 1e6;
  m.density = 1060;
  m.calibration_area = kPi * (ball * 1e-3) * (ball * 1e-3);
  m.calibration_spacing = 3 * r * 1e-3;
  m.fracture_toughness = toughness, m.blade_friction = kBladeFriction;
  return preset;
}

/// The lattice of the liver's row has Young's modulus 2.5 K S0 / s_cal (network::LatticeKind::cubic_18).
constexpr double kModulusPerK = 2.5 * kPi * 2e-3 * 2e-3 / 12e-3;

/// A tissue known by its Young's modulus [Pa]. What the source does not say is the liver's: the ratios of the moduli,
/// the time in which it creeps, toughness and friction.
constexpr MaterialPreset tissue(const char* name, double young, double density, double least, double most,
                                const char* source) {
  const double k = 1e-6 * young / kModulusPerK;  // [kPa/mm]
  MaterialPreset preset = row(name, name, 4, 2.0, k, k, 4 * k / 3, k / 3, kOrganToughness, least, most, 0, source, {});
  preset.material.density = density;
  preset.is_of_paper = false;
  return preset;
}

constexpr const char* kSlow =
    "Bao & Wu, section 5.1; viscosity read in kPa s/mm, which gives the creep of their Figs. 7 and 8";
constexpr const char* kPrinted = "Bao & Wu, section 5.1; viscosity as printed, in Pa s (per mm, like the moduli)";

constexpr std::array<MaterialPreset, 13> kPresets{
    row("liver", "liver", 4, 2.0, 15, 15, 20, 5, kOrganToughness, 0.08, 0.40, 0.012, kSlow, kLiverInSitu),
    row("kidney", "kidney", 4, 1.5, 58, 58, 106, 4, kOrganToughness, 0.07, 0.20, 0, kSlow, kKidneyInSitu),
    row("skin", "skin", 7, 2.8, 82, 82, 164, 3, kSkinToughness, 0.05, 0.50, 0, kSlow, kSkinInSitu),
    row("liver-pa-s", "liver", 4, 2.0, 15, 15, 20, 5e-3, kOrganToughness, 0.08, 0.40, 0.012, kPrinted, kLiverInSitu),
    row("kidney-pa-s", "kidney", 4, 1.5, 58, 58, 106, 4e-3, kOrganToughness, 0.07, 0.20, 0, kPrinted, kKidneyInSitu),
    row("skin-pa-s", "skin", 7, 2.8, 82, 82, 164, 3e-3, kSkinToughness, 0.05, 0.50, 0, kPrinted, kSkinInSitu),
    tissue(kGenericPreset, 20e3, 1060, 0.03, 0.40,
           "estimate: Young's modulus 20 kPa, between spleen and liver of this table; for tissue of no named organ"),
    tissue("heart", 20e3, 1060, 0.08, 0.20, "estimate: Young's modulus 20 kPa, relaxed; a beating heart is stiffer"),
    tissue("lung", 3.42e3, 300, 0.15, 0.40,
           "Young's modulus 3 times the shear stiffness of 1.14 kPa at residual volume (Mariappan et al., J. Magn. "
           "Reson. Imaging 33, 2011); density 300 kg/m^3, an estimate"),
    tissue("spleen", 10.7e3, 1060, 0.07, 0.20,
           "Young's modulus 3 times the shear stiffness of 3.565 kPa (Mannelli et al., AJR 195, 2010)"),
    tissue("bladder", 100e3, 1060, 0.05, 0.20,
           "estimate: Young's modulus 100 kPa of a slack wall; stretched samples reach 1.9 MPa (Martins et al., Int. "
           "Urogynecol. J. 22, 2011)"),
    tissue(
        "fat", 3.04e3, 920, 0.03, 0.40,
        "Young's modulus 3.04 kPa of breast fat and gland in the living (Briot et al., \"In vivo measurement of breast "
        "tissues stiffness using a light aspiration device\", Clin. Biomech. 99, 2022); density 920 kg/m^3, an "
        "estimate"),
    tissue("muscle", 20e3, 1060, 0.05, 0.50, "estimate: Young's modulus 20 kPa, across the fibres of relaxed muscle"),
};

}  // namespace

std::span<const MaterialPreset> material_presets() { return kPresets; }

const MaterialPreset* find_preset(std::string_view name) {
  for (const MaterialPreset& preset : kPresets)
    if (name == preset.name) return &preset;
  return nullptr;
}

const MaterialPreset* preset_in_name(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  const auto is_letter = [&](std::size_t i) { return i < lower.size() && std::isalpha((unsigned char)lower[i]); };
  for (const MaterialPreset& preset : kPresets) {
    const std::string_view organ = preset.organ;
    for (std::size_t at = lower.find(organ); at != std::string::npos; at = lower.find(organ, at + 1))
      // A short word may be a part of another: "fat" of "father".
      if (organ.size() > 3 || (!(at > 0 && is_letter(at - 1)) && !is_letter(at + organ.size()))) return &preset;
  }
  return nullptr;
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const MaterialPreset& preset : kPresets) names.emplace_back(preset.name);
  return names;
}

ResolvedMaterial resolve_material(const MaterialSpec& spec) {
  ResolvedMaterial resolved;
  const MaterialPreset* preset = find_preset(spec.preset);
  if (preset != nullptr) resolved.material = preset->material;
  network::Material& m = resolved.material;
  const auto take = [&](const std::optional<double>& own, double& value, const char* key) {
    if (own)
      value = *own;
    else if (preset == nullptr)
      resolved.missing.emplace_back(key);
  };
  take(spec.spring, m.spring, "spring_kpa_per_mm");
  take(spec.kelvin, m.kelvin, "kelvin_kpa_per_mm");
  take(spec.constraint, m.constraint, "constraint_kpa_per_mm");
  take(spec.viscosity, m.viscosity, "viscosity_kpa_s_per_mm");
  double ball = 0;
  take(spec.calibration_ball, ball, "calibration_ball_radius_mm");
  if (spec.calibration_ball) m.calibration_area = kPi * ball * ball;
  take(spec.calibration_spacing, m.calibration_spacing, "calibration_spacing_mm");
  m.density = spec.density.value_or(m.density);
  m.stiffness_scale = spec.stiffness_scale.value_or(m.stiffness_scale);
  m.prestrain = spec.prestrain.value_or(m.prestrain);
  m.fracture_toughness = spec.fracture_toughness.value_or(m.fracture_toughness);
  m.blade_friction = spec.blade_friction.value_or(m.blade_friction);
  return resolved;
}

}  // namespace ctpm::scenes
