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
/// the outside, from edge to edge, never reaches. Returns them by ascending index, or none if their removal would open
/// an edge or if an edge has more than 64 triangles. The mesh must be welded.
std::vector<std::int32_t> find_inner_walls(const Soup& soup);

}  // namespace ctpm::importers
