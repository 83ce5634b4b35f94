#pragma once

#include <cstdint>
#include <vector>

#include "importers/topology.h"

namespace ctpm::importers {

/// Closes T-junctions: vertices on the boundary of an opening that lie within `distance` [m] of a boundary edge without
/// being its end. Splits the edge's triangle there, so that both sides of the crack have the same vertices. Returns the
/// positions.
std::vector<Vec3> split_t_junctions(Soup& soup, double distance);

/// Finds walls inside a mesh: triangles that are attached by edges with more than two triangles and that a walk over
/// the outside, from edge to edge, never reaches. Returns only those whose removal opens no edge, by ascending index.
/// The mesh must be welded.
std::vector<std::int32_t> find_inner_walls(const Soup& soup);

}  // namespace ctpm::importers
