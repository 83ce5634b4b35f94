#pragma once

#include <cstdint>
#include <vector>

#include "core/model/vec3.h"
#include "importers/topology.h"

namespace ctpm::importers {

/// A closed line of edges that have a triangle on one side only.
struct Hole {
  Vec3 centre;          ///< mean of its vertices [m]
  double diameter = 0;  ///< twice the largest distance of its vertices from the centre [m]
  std::int64_t edges = 0;
};

/// Gives neighbouring triangles the same sense of rotation, splits vertices and edges at which that is
/// impossible or that are not manifold, and stitches edges again that fit together.
void orient_and_stitch(Soup& soup);

struct Closing {
  std::vector<Hole> filled;
  std::vector<Hole> too_large;
  std::vector<Hole> unfillable;  ///< within the limit, but no triangulation exists
};

/// Fills the holes of an oriented manifold mesh up to a diameter [m] with triangles of its own size.
Closing fill_holes(Soup& soup, double largest_hole);

/// Turns whole parts of a closed mesh so that together they bound a volume: outer ones outwards, cavities
/// inwards.
void orient_parts(Soup& soup);

}  // namespace ctpm::importers
