#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include "core/cutbody/cut_body.h"
#include "core/surface/surface.h"
#include "tests/core/blade_blocks.h"
#include "tests/core/skinned_block.h"

namespace ctpm::testing {

/// Cuts the first organ along the way of a front from 0 to 1: severs its elements and adds to the swept surface. The
/// cut is open.
inline void cut_along(const Model& model, const std::function<cutting::Front(double)>& way, State& state) {
  constexpr int kSteps = 60;
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  std::vector<cutting::Crossing> crossings;
  for (int i = 0; i < kSteps; ++i) {
    const cutting::Front from = way(double(i) / kSteps), to = way(double(i + 1) / kSteps);
    (void)sever(model, from, to, state, crossings);
    cutting::add_swept(state, from, to, newly);
  }
  state.open_cuts = {std::int32_t(cutting::swept_rows(state)), state.axial_severed};
}

/// Has cuts open so soon that a test needs few ticks.
inline void open_soon(State& state) {
  constexpr std::int64_t kTicks = 25;
  if (state.opening_cuts_at > 0) state.opening_cuts_at = std::min(state.opening_cuts_at, state.tick + kTicks);
}

/// A block with two cuts along y through all of it, up to `end` [m]. Between them is a strip of a seventh of a spacing
/// in which no sphere is: what is far along it follows the spheres beyond the cuts' end.
inline State long_strip(const Model& model, double end) {
  State state = rest_state(model);
  for (const double x : {-0.0007, 0.0011})
    cut_along(
        model,
        [&](double t) {
          const double y = -0.15 + t * (0.15 + end);
          return straight_front({x, y, -0.02}, {x, y, 0.06});
        },
        state);
  return state;
}

/// A block with a surface, a ball and a scalpel.
inline Model block_to_cut(int ni, int nj, int nk, double ball_radius,
                          network::Structure structure = network::Structure::ctpm) {
  network::Material material = liver_material();
  material.viscosity = 1e5;
  Model model = make_skinned_block(ni, nj, nk, structure, 0.003, material, network::Tiling::two_spheres);
  model.tools = {ball(ball_radius), scalpel(0.1)};
  return model;
}

/// The surface after the cuts of `state`, and where its vertices are.
struct DrawnCut {
  Surface surface;
  std::vector<Vec3> vertex;
  std::size_t outer_triangles = 0;
  int pieces = 0;

  DrawnCut(const Model& model, const State& state) {
    cutbody::CutBody body(model, 0);
    (void)body.update(state);
    surface = body.surface(), outer_triangles = body.outer_triangle_count(), pieces = body.piece_count();
    surface::deform_surface(surface, state.position, model.organs[0].first, vertex);
  }
};

}  // namespace ctpm::testing
