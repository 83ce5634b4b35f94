#pragma once

#include <vector>

#include "importers/lattice.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// The cells whose centres lie inside a closed, outward surface (winding number above 0), sorted by (k, j,
/// i). Each row of the lattice is one line that is cut with the surface. Whether a line hits a triangle is
/// decided edge by edge with the same arithmetic for both triangles of an edge, so a line can never slip
/// through between them.
std::vector<Cell> cells_inside(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle,
                               const Lattice& lattice);

}  // namespace ctpm::importers
