#pragma once

#include <cmath>
#include <cstdint>
#include <map>

#include "core/surface/surface.h"
#include "tests/core/blocks.h"

namespace ctpm::testing {

/// Adds to a block the drawn faces through its outermost spheres, divided into triangles with legs of `edge` [m].
inline void add_faces(FilledOrgan& organ, double edge) {
  Vec3 least = organ.centre.front(), most = organ.centre.back();
  const Vec3 size = most - least;
  const auto parts = [&](double length) { return std::max(1, int(std::lround(length / edge))); };
  const int count[3] = {parts(size.x), parts(size.y), parts(size.z)};
  std::map<std::array<int, 3>, std::int32_t> numbers;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [it, is_new] = numbers.try_emplace(at, std::int32_t(organ.surface.vertex.size()));
    if (is_new)
      organ.surface.vertex.push_back(
          least + Vec3{size.x * at[0] / count[0], size.y * at[1] / count[1], size.z * at[2] / count[2]});
    return it->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool is_high : {false, true}) {
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int i = 0; i < count[u]; ++i)
        for (int j = 0; j < count[v]; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at{};
            at[axis] = is_high ? count[axis] : 0, at[u] = i + di, at[v] = j + dj;
            return vertex(at);
          };
          const std::int32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (is_high)
            organ.surface.triangle.push_back({a, b, c}), organ.surface.triangle.push_back({a, c, d});
          else
            organ.surface.triangle.push_back({a, c, b}), organ.surface.triangle.push_back({a, d, c});
        }
    }
  surface::bind_surface(organ);
}

/// A block as make_block_model() makes it, with a surface through its outermost spheres, of triangles with legs of
/// about `edge` [m].
inline Model make_skinned_block(int ni, int nj, int nk, network::Structure structure = network::Structure::mass_spring,
                                double edge = 0.003, network::Material material = liver_material(),
                                network::Tiling tiling = network::Tiling::three_spheres) {
  FilledOrgan organ = make_block(ni, nj, nk);
  add_faces(organ, edge);
  network::OrganSettings settings;
  settings.name = "block", settings.structure = structure, settings.material = material;
  settings.tiling = tiling;
  for (int i = 0; i < ni * nj; ++i) settings.anchored.push_back(i);
  Model model;
  CTPM_CHECK(bool(network::add_organ(model, organ, settings)), "a test's own block is valid");
  model.contact_friction = 0.3;
  stepping::resolve_integrator(model);
  return model;
}

}  // namespace ctpm::testing
