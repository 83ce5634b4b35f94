#pragma once

#include <vector>

#include "importers/lattice.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// The cells whose centres lie inside a closed, outward surface (winding number above 0), sorted by (k, j, i). Each
/// lattice row is a line that is intersected with the surface. The hit test runs edge by edge with the same arithmetic
/// for both triangles of an edge, so the test is watertight.
std::vector<Cell> cells_inside(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle,
                               const Lattice& lattice);

}  // namespace ctpm::importers
