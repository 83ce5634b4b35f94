#include "studio/authoring/capsule.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/network/tissue_cells.h"
#include "importers/topology.h"
#include "scenes/presets.h"

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

std::optional<scenes::LayerSpec> capsule_of(const scenes::MaterialSpec& material, const FilledOrgan& filled) {
  constexpr double kMost = 0.3;  // strain; beyond it the organ is not one of the preset's
  const scenes::MaterialPreset* preset = scenes::find_preset(material.preset);
  if (preset == nullptr || filled.surface.vertex.empty()) return {};
  const double depth = filled.spacing;
  const auto inside = [&](double d) { return d < depth; };
  if (std::none_of(filled.depth.begin(), filled.depth.end(), inside) ||
      std::all_of(filled.depth.begin(), filled.depth.end(), inside))
    return {};
  const double modulus = relaxed_modulus(scenes::resolve_material(material).material);
  const double strain = preset->in_situ.strain > 0 ? preset->in_situ.strain
                                                   : preset->in_situ.pressure * radius_of(filled.surface) *
                                                         (1 - kPoisson) / (2 * modulus * depth);
  scenes::LayerSpec layer;
  layer.to_depth = depth, layer.material = material;
  layer.material.fitted_for.reset();
  layer.material.prestrain = std::round(1e3 * std::min(strain, kMost)) / 1e3;
  if (!(*layer.material.prestrain > 0)) return {};
  return layer;
}

}  // namespace ctpm::authoring
