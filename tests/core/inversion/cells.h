#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/model/model.h"
#include "core/model/state.h"
#include "tests/core/blocks.h"

namespace ctpm::testing {

/// J of corner `corner` of a tissue cell of a lattice with `spacing` [m], written down once more: the triple product of
/// the edges towards larger i, j, k.
inline double volume_ratio(const Model& model, const Vec3Array& position, std::size_t cell, std::size_t corner,
                           double spacing = 0.012) {
  const auto at = [&](std::size_t c) { return position[std::size_t(model.tissue_cells.corner[c][cell])]; };
  Vec3 edge[3];
  for (std::size_t axis = 0; axis < 3; ++axis)
    edge[axis] = at(corner | std::size_t{1} << axis) - at(corner & ~(std::size_t{1} << axis));
  return dot(edge[0], cross(edge[1], edge[2])) / (spacing * spacing * spacing);
}

inline double least_volume_ratio(const Model& model, const Vec3Array& position, std::size_t cell,
                                 double spacing = 0.012) {
  double least = volume_ratio(model, position, cell, 0, spacing);
  for (std::size_t c = 1; c < 8; ++c) least = std::min(least, volume_ratio(model, position, cell, c, spacing));
  return least;
}

/// Cells with a corner whose J is below `limit`.
inline std::vector<std::size_t> cells_below(const Model& model, const Vec3Array& position, double limit) {
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < model.tissue_cells.size(); ++cell)
    if (least_volume_ratio(model, position, cell) < limit) cells.push_back(cell);
  return cells;
}

/// A block that stands on anchored spheres and resists inversion; soft enough for leapfrog if that is asked for.
inline Model make_resisting_block(int ni, int nj, int nk, Integrator integrator, double resistance = 10,
                                  network::Structure structure = network::Structure::ctpm) {
  network::Material material = liver_material();
  if (integrator == Integrator::leapfrog) material.viscosity = 2e4, material.stiffness_scale = 0.29;
  Model model = make_block_model(ni, nj, nk, structure, material, 0.012, resistance);
  use_integrator(model, integrator);
  if (integrator == Integrator::leapfrog) model.solver.substeps = 2;
  return model;
}

/// Largest distance of a sphere from its place in `rest` [m].
inline double farthest_from(const State& rest, const State& state) {
  double farthest = 0;
  for (std::size_t i = 0; i < state.position.size(); ++i)
    farthest = std::max(farthest, norm(state.position[i] - rest.position[i]));
  return farthest;
}

}  // namespace ctpm::testing
