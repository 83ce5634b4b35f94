#pragma once

#include <cstdint>

#include "importers/topology.h"

namespace ctpm::importers {

/// Coarsens a closed manifold mesh to at most `most_triangles`, or as near to it as possible without flipping a
/// triangle or changing the topology. Collapses edges in order of a cost that preserves volume (Lindstrom and Turk
/// 1998). Deterministic.
Soup coarsen(const Soup& soup, std::int64_t most_triangles);

}  // namespace ctpm::importers
