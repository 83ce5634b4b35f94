#include "studio/rig/site.h"

#include <cmath>
#include <numbers>

#include "scenes/presets.h"

namespace ctpm::rig {

Site site_of(const scenes::OrganSpec& organ) {
  const network::Material m = scenes::resolve_material(organ.material).material;
  Site site;
  site.spring = m.spring * 1e-6, site.kelvin = m.kelvin * 1e-6, site.constraint = m.constraint * 1e-6;
  site.viscosity = m.viscosity * 1e-6;
  site.arm = 2e3 * m.calibration_spacing;
  site.ball_radius = 1e3 * std::sqrt(m.calibration_area / std::numbers::pi);
  return site;
}

}  // namespace ctpm::rig
