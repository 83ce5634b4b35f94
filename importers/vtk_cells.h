#pragma once

#include <cstdint>
#include <vector>

#include "importers/volume_mesh.h"

namespace ctpm::importers {

/// Adds VTK's cells, whose points are `corner[offset[n]] .. corner[offset[n + 1]]`; `type` has VTK's numbers of cell
/// types. Lines and points are left out. Throws BrokenMesh for types that are not read and offsets that do not fit.
void add_vtk_cells(const std::vector<std::int64_t>& offset, const std::vector<std::int64_t>& corner,
                   const std::vector<std::int64_t>& type, VolumeMesh& mesh);

/// VTK's number of a polygon.
inline constexpr std::int64_t kVtkPolygon = 7;

}  // namespace ctpm::importers
