#pragma once

#include <cstdint>

#include "importers/topology.h"

namespace ctpm::importers {

/// A closed manifold mesh with at most `most_triangles` if that can be had without turning a triangle over or
/// changing what is joined to what; else with as few as can be. Collapses edges in the order of what they
/// change (Lindstrom and Turk 1998), which keeps the volume. The same mesh always gives the same one.
Soup coarsen(const Soup& soup, std::int64_t most_triangles);

}  // namespace ctpm::importers
