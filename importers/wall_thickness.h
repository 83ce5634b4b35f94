#pragma once

#include <vector>

#include "importers/mesh.h"

namespace ctpm::importers {

/// How thick the tissue mostly is below the marked part of a mesh's surface [m], at most `most`: the median diameter,
/// by area, of the largest balls in the mesh that touch triangles with a marked vertex. `is_marked`: at least one
/// (vertex_count).
double wall_thickness(const CheckedMesh& mesh, const std::vector<char>& is_marked, double most);

}  // namespace ctpm::importers
