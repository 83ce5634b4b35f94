#pragma once

#include "importers/topology.h"

namespace ctpm::importers {

/// Splits edges of a closed manifold mesh until none is longer than `longest` [m], > 0. The surface keeps its shape.
/// Deterministic.
Soup refine(const Soup& soup, double longest);

}  // namespace ctpm::importers
