#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "core/cutting/cutting.h"
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
  model.tools = {scalpel(0.1)};
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

/// A front that lies along a straight edge.
inline cutting::Front straight_front(Vec3 tip, Vec3 heel) {
  cutting::Front front;
  for (std::size_t n = 0; n < kEdgeNodes; ++n) front[n] = tip + double(n) / double(kEdgeNodes - 1) * (heel - tip);
  return front;
}

/// Severs what a straight front crosses in the first organ.
inline std::int32_t sever(const Model& model, const cutting::Front& from, const cutting::Front& to, State& state,
                          std::vector<cutting::Crossing>& crossings) {
  cutting::NewlySwept newly;
  newly.fill(1);
  return cutting::sever_swept(model, cutting::RestElements(model), from, to, newly, state, crossings);
}

/// Area of the swept surface within a box at rest [m^2].
inline double swept_area(const State& state, Vec3 low, Vec3 high) {
  constexpr int kParts = 16;
  double area = 0;
  cutting::for_each_swept(state, [&](const cutting::SweptQuad& q) {
    const double whole =
        0.5 * (norm(cross(q.to - q.from, q.from2 - q.from)) + norm(cross(q.to2 - q.to, q.from2 - q.to)));
    for (int i = 0; i < kParts; ++i)
      for (int j = 0; j < kParts; ++j) {
        const double u = (i + 0.5) / kParts, v = (j + 0.5) / kParts;
        const Vec3 p = (1 - v) * ((1 - u) * q.from + u * q.to) + v * ((1 - u) * q.from2 + u * q.to2);
        if (p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z)
          area += whole / (kParts * kParts);
      }
  });
  return area;
}

/// Work of the hand along its path [J].
struct Work {
  double by_hand = 0;
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
  return work;
}

}  // namespace ctpm::testing
