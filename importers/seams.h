#pragma once

#include <cstdint>
#include <vector>

#include "importers/topology.h"

namespace ctpm::importers {

/// T-junctions: vertices on the rim of an opening that lie on another rim's edge, within `distance` [m], and
/// are none of its ends. The edge's triangle is split there, so that both sides of the crack have the same
/// vertices. Returns the places.
std::vector<Vec3> split_t_junctions(Soup& soup, double distance);

/// Walls inside a mesh: triangles that hang on it by edges of more than two triangles and that nobody sees
/// who goes over its outside from edge to edge. Only those without which no edge becomes open; in the order
/// of their index. The mesh is welded.
std::vector<std::int32_t> find_inner_walls(const Soup& soup);

}  // namespace ctpm::importers
