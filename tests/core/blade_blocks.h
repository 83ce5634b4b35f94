#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "core/stepping/step.h"
#include "tests/core/blocks.h"

namespace ctpm::testing {

inline constexpr double kToughness = 164, kFriction = 2000;  // [J/m^2], [Pa]

inline network::Material resisting(double toughness = kToughness, double friction = 0) {
  network::Material material = liver_material();
  material.fracture_toughness = toughness, material.blade_friction = friction;
  return material;
}

/// A block with a blade longer than the block is high.
inline Model block_with_blade(int ni, int nj, int nk, const network::Material& material,
                              network::Structure structure = network::Structure::ctpm) {
  Model model = make_block_model(ni, nj, nk, structure, material);
  model.tools = {scalpel(0.2)};
  model.solver.tolerance = 1e-11, model.solver.velocity_floor = 1e-14, model.solver.max_iterations = 2000;
  return model;
}

inline Model held_block(int ni, int nj, int nk, const network::Material& material = resisting()) {
  Model model = block_with_blade(ni, nj, nk, material);
  model.held_axes.assign(model.sphere_count(), kAnchored);
  return model;
}

inline Model free_block(int ni, int nj, int nk, const network::Material& material = resisting()) {
  Model model = block_with_blade(ni, nj, nk, material);
  model.held_axes.assign(model.sphere_count(), 0);
  return model;
}

inline Inputs blade_at(Vec3 tip) {
  Inputs inputs;
  inputs.tool = 0, inputs.position = tip;
  return inputs;
}

inline double kinetic_energy(const Model& model, const State& state) {
  double sum = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    sum += 0.5 * model.mass[i] * dot(state.velocity[i], state.velocity[i]);
  return sum;
}

inline Vec3 momentum(const Model& model, const State& state) {
  Vec3 sum;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) sum += model.mass[i] * state.velocity[i];
  return sum;
}

/// Energy of opening the plane with this normal at the severed elements [J].
inline double fracture_energy(const Model& model, const State& state, Vec3 normal) {
  double sum = 0;
  const AxialElements& axial = model.axial;
  for (std::size_t e = 0; e < axial.size(); ++e) {
    const Vec3 d = model.rest_position[std::size_t(axial.b[e])] - model.rest_position[std::size_t(axial.a[e])];
    if (state.axial_severed[e]) sum += model.cut_resistance.energy[e] * std::abs(dot(normal, d)) / norm(d);
  }
  return sum;
}

/// Work of the hand along its path through a held block, and fracture energy of the severed elements [J].
struct Work {
  double by_hand = 0, of_fracture = 0;
  State state;
};

inline Work cut_through(const Model& model, double per_tick, Vec3 start, Vec3 way) {
  Work work;
  work.state = rest_state(model);
  stepping::Stepper stepper(model);
  const Vec3 direction = way / norm(way);
  const int ticks = int(std::ceil(norm(way) / per_tick));
  for (int i = 0; i <= ticks; ++i) {
    const stepping::StepReport report =
        stepper.step(work.state, blade_at(start + std::min(i * per_tick, norm(way)) * direction));
    if (i > 0) work.by_hand -= per_tick * dot(report.tool_force, direction);
    EXPECT_LE(dot(report.tool_force, direction), 0) << "the blade is never drawn in";
  }
  const Vec3 across = cross(direction, {0, 0, 1});
  work.of_fracture = fracture_energy(model, work.state, across / norm(across));
  return work;
}

}  // namespace ctpm::testing
