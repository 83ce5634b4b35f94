#pragma once

#include <vector>

#include "importers/cover_lattice.h"
#include "importers/fill.h"

namespace ctpm::importers {

/// Distances between the outer boundary of the spheres of a cover and the mesh's surface, both ways: from points spread
/// evenly over the surface to the nearest sphere's boundary, and from the outermost point of each outer sphere (one
/// that misses a neighbour along an axis) to the surface, which counts as much as the tissue that it stands for. Each
/// figure is the larger of the two ways, as in the Hausdorff distance. `depth`: of each sphere's centre below the
/// surface, negative outside [m]; `radius`: of the spheres [m].
ShapeError measure_shape(const CheckedMesh& mesh, const Cover& cover, const std::vector<double>& depth, double radius,
                         int threads);

}  // namespace ctpm::importers
