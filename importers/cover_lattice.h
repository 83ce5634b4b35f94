#pragma once

#include <vector>

#include "core/model/organ.h"
#include "importers/lattice.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// The spheres of a lattice that covers a mesh, and the material that each stands for.
struct Cover {
  Lattice lattice;         ///< of the spheres
  std::vector<Cell> cell;  ///< coordinates of each sphere, sorted by (k, j, i)          (sphere_count)
  TissueShares shares;     ///< (sphere_count)
};

/// Covers a closed mesh with a lattice whose cells are cubes with a sphere at each corner. `cells` has the cubes'
/// centres; it must contain the mesh.
///
/// A full cell gives a quarter to each of its twelve axis elements, since four cells share one, and half to both
/// diagonals of each face, since two share one. A cell that the surface cuts gives what its tissue gives: each bit is
/// weighted by hat functions across the element, bilinear for an axis element, linear for a diagonal. The integrals are
/// exact along x and sampled along y and z. Cut cells are scaled so that the volume is the mesh's; those that hold less
/// than 2 % of tissue are left out. Empty if no cell holds more.
Cover cover_with_cells(const CheckedMesh& mesh, const Lattice& cells);

/// Keeps only the spheres for which `keep` is true. No element may join a kept sphere to another.
void keep_only(Cover& cover, const std::vector<char>& keep);

}  // namespace ctpm::importers
