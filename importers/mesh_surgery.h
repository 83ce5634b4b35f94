#pragma once

#include <cstdint>
#include <vector>

#include "core/model/vec3.h"
#include "importers/topology.h"

namespace ctpm::importers {

/// A closed loop of edges with a triangle on one side only.
struct Hole {
  Vec3 centre;          ///< mean of its vertices [m]
  double diameter = 0;  ///< twice the largest distance of a vertex from the centre [m]
  std::int64_t edges = 0;
};

/// Orients neighbouring triangles consistently, splits vertices and edges where that is impossible or that are not
/// manifold, and stitches matching edges.
void orient_and_stitch(Soup& soup);

struct Closing {
  std::vector<Hole> filled;
  std::vector<Hole> too_large;
  std::vector<Hole> unfillable;  ///< within the limit, but no triangulation exists
};

/// Fills the holes up to a diameter [m] of an oriented manifold mesh with triangles of the size of its own.
Closing fill_holes(Soup& soup, double largest_hole);

/// Orients the parts of a closed mesh so that together they bound a volume: outer surfaces outwards, cavities inwards.
void orient_parts(Soup& soup);

}  // namespace ctpm::importers
