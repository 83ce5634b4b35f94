#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/model/model.h"

namespace ctpm::inversion {

/// Spheres of one corner tetrahedron: the corner, then its neighbours along i, j and k.
using CornerSpheres = std::array<std::int32_t, 4>;

inline CornerSpheres spheres_of(const TissueCells& cells, std::size_t cell, std::size_t corner) {
  return {cells.corner[corner][cell], cells.corner[corner ^ 1][cell], cells.corner[corner ^ 2][cell],
          cells.corner[corner ^ 4][cell]};
}

/// Six times the signed volume of a corner tetrahedron [m^3], and its gradient over the positions of the neighbours
/// [m^2]. That over the corner's position is minus their sum.
struct CornerVolume {
  double volume;
  std::array<Vec3, 3> gradient;
};

inline CornerVolume volume_of(const CornerSpheres& spheres, std::size_t corner, const Vec3Array& position) {
  const auto sign = [&](std::size_t axis) { return (corner >> axis & 1) != 0 ? -1.0 : 1.0; };
  const Vec3 at = position[std::size_t(spheres[0])];
  const auto edge = [&](std::size_t axis) { return sign(axis) * (position[std::size_t(spheres[axis + 1])] - at); };
  const Vec3 i = edge(0), j = edge(1), k = edge(2), of_i = cross(j, k);
  return {dot(i, of_i), {sign(0) * of_i, sign(1) * cross(k, i), sign(2) * cross(i, j)}};
}

/// Six times the volume of a cell's corner tetrahedra at rest [m^3]; those of a lattice cube are all equal.
inline double rest_volume(const Model& model, std::size_t cell) {
  return volume_of(spheres_of(model.tissue_cells, cell, 0), 0, model.rest_position).volume;
}

}  // namespace ctpm::inversion
