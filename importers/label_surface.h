#pragma once

#include "importers/label_map.h"
#include "importers/topology.h"

namespace ctpm::importers {

/// The closed surface of a label [mm, LPS], outwards, without the steps of its voxels: the label's share of each voxel
/// is smoothed by about a voxel, and the surface runs where the share has the value at which it encloses the volume of
/// the label's voxels, to 0.1 %, or 1 % where a symmetric label leaves no value between. Voxels that are much finer
/// than the label needs are joined first, so that a compact label has some ten thousand triangles. Marching tetrahedra
/// (Doi & Koide 1991), which leave no gap and no ambiguous case; then the steps that are left are evened out. Empty if
/// the label has no voxels.
Soup label_surface(const LabelMap& map, const Label& label);

}  // namespace ctpm::importers
