#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm {

/// Spheres that tell how the tissue around them has turned. They may lie in a plane, on a line, or be one.
struct TissueFrame {
  /// The spheres, within the organ, how much each counts (> 0, sum to 1), and where each is at rest, seen from their
  /// weighted mean [m].
  std::vector<std::int32_t> sphere;
  std::vector<double> weight;
  std::vector<Vec3> arm;
};

/// A distance that turns with a frame. It is added to the weighted sum of a vertex's spheres, so that a thin piece
/// keeps its thickness.
struct TurnedOffset {
  std::int32_t vertex = -1, frame = -1;
  Vec3 offset;  ///< at rest [m]
};

/// How the vertices of a render surface follow the spheres: each is a weighted sum of sphere positions. The weights
/// reproduce every linear function of the rest positions, so the surface follows any rigid motion exactly, except at
/// vertices whose spheres do not span space (see surface::follow_weights).
struct SurfaceBinding {
  std::vector<std::int32_t> first;   ///< where a vertex's entries begin; the last value is the total (vertex_count + 1)
  std::vector<std::int32_t> sphere;  ///< the sphere of an entry (entry_count)
  std::vector<double> weight;        ///< its weight; a vertex's weights sum to 1                     (entry_count)
  /// What weights cannot give to vertices whose spheres do not span space, ascending by vertex; a vertex may have
  /// several. Only a cut surface has any.
  std::vector<TurnedOffset> turned;
  std::vector<TissueFrame> frame;
};

/// The watertight triangle mesh that is drawn for one organ, oriented outwards.
struct Surface {
  std::vector<Vec3> vertex;                           ///< rest positions [m]                          (vertex_count)
  std::vector<std::array<std::int32_t, 3>> triangle;  ///< counter-clockwise seen from outside         (triangle_count)
  SurfaceBinding binding;                             ///< which spheres the vertices follow; indices within the organ
};

/// Directions from a sphere to the neighbours that elements join it to: three axes, six face diagonals. In each, the
/// last non-zero component is positive, so that the neighbour comes later in the (k, j, i) order.
inline constexpr std::array<std::array<std::int32_t, 3>, 9> kLatticeDirections{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {-1, 1, 0}, {1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}}};
inline constexpr std::size_t kAxisDirectionCount = 3;  ///< of kLatticeDirections, which begins with the axes

/// Which part of a full lattice's material each cell, element and sphere stands for. The lattice covers the organ, so
/// cells at the surface hold tissue only in part. Empty arrays: everything is full, as in a rig.
struct TissueShares {
  /// Of the cubic cell of which the sphere is the lowest corner, filled part; 0: no cell              (sphere_count)
  std::vector<double> cell;
  /// Of the element from the sphere along each of kLatticeDirections; 0: no element                   (sphere_count)
  std::array<std::vector<double>, kLatticeDirections.size()> element;
  /// Volume that moves with the sphere, in spacings cubed: half of each of its elements' part, so that no sphere is
  /// much lighter than its elements are stiff. Their sum is the organ's volume                          (sphere_count)
  std::vector<double> sphere;

  bool empty() const { return sphere.empty(); }
  double of_element(std::size_t sphere_index, std::size_t direction) const {
    return empty() ? 1 : element[direction][sphere_index];
  }
  double of_sphere(std::size_t sphere_index) const { return empty() ? 1 : sphere[sphere_index]; }
};

/// An organ filled with layered spheres of equal radius on a cubic lattice that covers it.
struct FilledOrgan {
  double sphere_radius = 0;                       ///< r [m], > 0
  double spacing = 0;                             ///< s = 2 r + gap, centre to centre along a lattice axis [m], > 0
  std::vector<Vec3> centre;                       ///< rest positions [m], sorted by (k, j, i)        (sphere_count)
  std::vector<std::array<std::int32_t, 3>> cell;  ///< lattice coordinates i, j, k of each sphere     (sphere_count)
  std::vector<std::int32_t> layer;                ///< 1 = outermost, counted inwards by depth        (sphere_count)
  /// Distance of the centre below the surface [m]; negative outside                                   (sphere_count)
  std::vector<double> depth;
  TissueShares shares;
  Surface surface;
};

}  // namespace ctpm
