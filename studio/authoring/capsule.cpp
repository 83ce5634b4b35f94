#include "studio/authoring/capsule.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/network/tissue_cells.h"
#include "importers/topology.h"
#include "scenes/presets.h"
#include "studio/authoring/scene_parts.h"

namespace ctpm::authoring {
namespace {

constexpr double kPoisson = 0.25;  // LatticeKind::cubic_18

/// Young's modulus of the lattice once its Kelvin units have crept: the springs are in series with them [Pa].
double relaxed_modulus(const network::Material& m) {
  const double relaxed = m.stiffness_scale * m.spring * m.kelvin / (m.spring + m.kelvin);
  return network::kYoungOverEdge * relaxed * m.calibration_area / m.calibration_spacing;
}

/// Radius of the sphere of the organ's volume [m].
double radius_of(const Surface& surface) {
  const double volume = importers::signed_volume(surface.vertex, surface.triangle, surface.vertex.front());
  return std::cbrt(std::max(volume, 0.0) * 3 / (4 * std::numbers::pi));
}

}  // namespace

std::optional<Tension> tension_of(const scenes::MaterialSpec& material, const FilledOrgan& filled) {
  constexpr double kMost = 0.3;  // strain; beyond it the organ is not one of the preset's
  const scenes::MaterialPreset* preset = scenes::find_preset(material.preset);
  if (preset == nullptr || filled.surface.vertex.empty()) return {};
  const double depth = filled.spacing;
  double outer = 0, all = 0;
  for (std::size_t s = 0; s < filled.depth.size(); ++s) {
    const double tissue = filled.shares.of_sphere(s);
    all += tissue, outer += filled.depth[s] < depth ? tissue : 0;
  }
  if (!(outer > 0) || !(outer < all)) return {};
  const double modulus = relaxed_modulus(scenes::resolve_material(material).material);
  Tension tension;
  tension.strain = preset->in_situ.strain > 0
                       ? preset->in_situ.strain
                       : preset->in_situ.pressure * radius_of(filled.surface) * (1 - kPoisson) / (2 * modulus * depth);
  tension.strain = std::min(tension.strain, kMost);
  const auto rounded = [](double strain) { return std::round(1e3 * strain) / 1e3; };
  // Without the tissue inside, the organ would become smaller by this.
  const double smaller = tension.strain * outer / all, size = 1 - smaller;
  tension.inside = rounded(1 - 1 / size);
  tension.capsule.to_depth = whole_nanometres(depth), tension.capsule.material = material;
  tension.capsule.material.fitted_for.reset();
  tension.capsule.material.prestrain = rounded(1 - (1 - tension.strain) / size);
  if (!(*tension.capsule.material.prestrain > 0)) return {};
  return tension;
}

}  // namespace ctpm::authoring
