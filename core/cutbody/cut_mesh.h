#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/cutbody/cut_grid.h"
#include "core/model/vec3.h"

namespace ctpm::cutbody {

/// The closed surface of an organ after its cuts, at rest.
struct CutMesh {
  struct Vertex {
    Vec3 rest;            ///< [m]
    CutGrid::Index side;  ///< node of the grid whose tissue the vertex belongs to
  };
  std::vector<Vertex> vertex;
  std::vector<std::array<std::int32_t, 3>> triangle;  ///< counter-clockwise seen from outside; outer ones first
  std::size_t outer_triangles = 0;                    ///< those of the organ's own surface; the others are walls
  std::vector<CutGrid::Index> cube;                   ///< of the grid, that each triangle is in
};

/// Divides the grid's tissue along the swept surface: the nodes of a tetrahedron that are joined by edges within it
/// share one label, and a surface separates each two labels, and each from what is outside, once for each side. The
/// surface goes through the crossings of the edges. Where two labels are joined beyond an edge or a face of the
/// tetrahedron, the cut ends there, and its two sides meet. Every edge therefore belongs to two triangles: the mesh is
/// watertight, and has a closed component for each piece of tissue.
CutMesh make_mesh(const CutGrid& grid);

/// Makes the mesh of a grid again and again, anew only where it changed in between.
class Mesher {
 public:
  /// `grid` must outlive the Mesher.
  explicit Mesher(const CutGrid& grid);
  ~Mesher();

  /// Follows the grid, of which edges in a box have changed.
  void update(const CutGrid::NodeBox& changed);
  /// The same as make_mesh(), but only of the cubes in these blocks of the grid; in all if there are none.
  CutMesh make(const std::vector<std::uint8_t>& blocks);

 private:
  friend CutMesh make_mesh_around(const CutGrid& grid, CutGrid::Index block);
  class Parts;
  std::unique_ptr<Parts> parts_;
  const CutGrid& grid_;
};

/// The same of one block of the grid and the cubes around it: within the block, vertices and triangles are those of the
/// whole mesh.
CutMesh make_mesh_around(const CutGrid& grid, CutGrid::Index block);

/// Number of pieces of tissue: components of the grid's nodes.
std::int32_t count_pieces(const CutGrid& grid);

}  // namespace ctpm::cutbody
