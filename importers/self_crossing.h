#pragma once

#include <cstdint>
#include <vector>

#include "importers/topology.h"

namespace ctpm::importers {

/// Finds triangles of a manifold mesh that intersect or overlap others, by ascending index. Sharing an edge or a corner
/// does not count. The result does not depend on `threads` >= 1.
std::vector<std::int32_t> find_crossing(const Soup& soup, int threads = 1);

/// Removes the crossing triangles and up to four rings around them from a closed mesh of one part, and fills the holes.
/// Succeeds only if no hole is wider than `largest_hole` [m], the mesh stays closed, in one part and of the same genus,
/// its volume changes by at most 2 %, and nothing intersects any more. Returns the number of triangles removed; 0:
/// `soup` is unchanged.
std::int64_t cut_crossing(Soup& soup, const std::vector<std::int32_t>& crossing, double largest_hole);

}  // namespace ctpm::importers
