#pragma once

#include <cstdint>
#include <vector>

#include "importers/topology.h"

namespace ctpm::importers {

/// Triangles of a manifold mesh that pass through others or lie on them, in the order of their index.
/// Triangles that only share an edge or a corner are not meant.
std::vector<std::int32_t> find_crossing(const Soup& soup);

/// Cuts the crossing triangles and their surroundings out of a closed mesh of one part and fills the holes
/// that this leaves, if none of them is wider than `largest_hole` [m], the mesh stays closed, in one part and
/// of the same genus, and nothing crosses any more. Returns how many triangles were cut out; 0: `soup` is as
/// it was.
std::int64_t cut_crossing(Soup& soup, const std::vector<std::int32_t>& crossing, double largest_hole);

}  // namespace ctpm::importers
