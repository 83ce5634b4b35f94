#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/model/model.h"
#include "core/model/organ.h"
#include "core/model/state.h"
#include "core/network/network.h"
#include "core/stepping/integrator.h"

namespace ctpm::testing {

/// Moduli of the paper's liver (Table 1 and section 5.1), viscosity in kPa s/mm.
inline network::Material liver_material() {
  network::Material m;
  m.spring = m.kelvin = 15e6;
  m.constraint = 20e6;
  m.viscosity = 5e6;
  m.calibration_area = 3.14159265358979323846 * 0.002 * 0.002;
  m.calibration_spacing = 0.012;
  return m;
}

/// An organ of ni x nj x nk spheres with a spacing of three radii, centred on the z axis, standing on z = 0.
inline FilledOrgan make_block(int ni, int nj, int nk, double spacing = 0.012) {
  FilledOrgan organ;
  organ.sphere_radius = spacing / 3;
  organ.spacing = spacing;
  for (int k = 0; k < nk; ++k)
    for (int j = 0; j < nj; ++j)
      for (int i = 0; i < ni; ++i) {
        organ.cell.push_back({i, j, k});
        organ.centre.push_back({spacing * (i - 0.5 * (ni - 1)), spacing * (j - 0.5 * (nj - 1)), spacing * k});
        const int rim = std::min({i, ni - 1 - i, j, nj - 1 - j, k, nk - 1 - k});
        organ.layer.push_back(1 + rim);
        organ.depth.push_back(spacing / 2 + spacing * rim);
      }
  return organ;
}

/// A Model of one block whose lowest spheres are anchored.
inline Model make_block_model(int ni, int nj, int nk, network::Structure structure = network::Structure::ctpm,
                              network::Material material = liver_material(), double spacing = 0.012,
                              double inversion_resistance = 0) {
  const FilledOrgan organ = make_block(ni, nj, nk, spacing);
  network::OrganSettings settings;
  settings.name = "block";
  settings.structure = structure;
  settings.material = material;
  settings.inversion_resistance = inversion_resistance;
  for (int i = 0; i < ni * nj; ++i) settings.anchored.push_back(i);
  Model model;
  const Result<Done> added = network::add_organ(model, organ, settings);
  CTPM_CHECK(bool(added), "a test's own block is valid");
  model.contact_k = 20 * material.spring * network::edge_area(material, organ.spacing);
  model.contact_friction = 0.3;
  stepping::resolve_integrator(model);
  return model;
}

/// Sets the integrator, with one step per tick, instead of the one that make_block_model() chose.
inline void use_integrator(Model& model, Integrator integrator) {
  model.solver.integrator = integrator, model.solver.substeps = 1;
}

inline Tool ball(double radius) { return {"ball", ToolKind::ball, radius, 0}; }
inline Tool scalpel(double blade_length) { return {"scalpel", ToolKind::scalpel, 0, blade_length}; }

/// Pseudo-random numbers in [-1, 1], equal on every machine (64-bit linear congruential generator).
class Noise {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return double(std::int64_t(state_) >> 11) / double(1ll << 52);
  }
  Vec3 next_vec3() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }

 private:
  std::uint64_t state_ = 42;
};

/// Displaces every sphere by up to `amount` [m] and gives it a velocity of up to `speed` [m/s].
inline void shake(State& state, double amount, double speed = 0) {
  Noise noise;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    state.position.add(i, amount * noise.next_vec3());
    state.velocity.add(i, speed * noise.next_vec3());
  }
}

}  // namespace ctpm::testing
