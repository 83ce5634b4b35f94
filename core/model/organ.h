#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm {

/// How the vertices of a render surface follow the spheres: each is a weighted sum of sphere positions. The weights
/// reproduce every linear function of the rest positions, so the surface follows any rigid motion exactly, except at
/// vertices whose spheres do not span space (see surface::follow_weights).
struct SurfaceBinding {
  std::vector<std::int32_t> first;   ///< where a vertex's entries begin; the last value is the total (vertex_count + 1)
  std::vector<std::int32_t> sphere;  ///< the sphere of an entry (entry_count)
  std::vector<double> weight;        ///< its weight; a vertex's weights sum to 1                     (entry_count)
};

/// The watertight triangle mesh that is drawn for one organ, oriented outwards.
struct Surface {
  std::vector<Vec3> vertex;                           ///< rest positions [m]                          (vertex_count)
  std::vector<std::array<std::int32_t, 3>> triangle;  ///< counter-clockwise seen from outside         (triangle_count)
  SurfaceBinding binding;                             ///< which spheres the vertices follow; indices within the organ
};

/// The inside of an organ, filled with layered spheres of equal radius on a cubic lattice.
struct FilledOrgan {
  double sphere_radius = 0;                       ///< r [m], > 0
  double spacing = 0;                             ///< s = 2 r + gap, centre to centre along a lattice axis [m], > 0
  std::vector<Vec3> centre;                       ///< rest positions [m], sorted by (k, j, i)        (sphere_count)
  std::vector<std::array<std::int32_t, 3>> cell;  ///< lattice coordinates i, j, k of each sphere     (sphere_count)
  std::vector<std::int32_t> layer;                ///< 1 = outermost, counted inwards by depth        (sphere_count)
  std::vector<double> depth;                      ///< distance of the centre below the surface [m]   (sphere_count)
  Surface surface;
};

}  // namespace ctpm
