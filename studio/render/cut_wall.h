#pragma once

#include <map>
#include <utility>
#include <vector>

#include "studio/render/cut_vertices.h"

namespace ctpm::render {

/// An edge of the split outer surface at which the wall begins, in the direction of its outer triangle.
struct Lip {
  CutVertices::Index from, to;
};

/// Where the outer surface was split.
struct SplitLine {
  std::vector<Lip> lips;
  /// (u, v): the vertex that splits the edge u-v, in the copy on u's side.
  std::map<std::pair<CutVertices::Index, CutVertices::Index>, CutVertices::Index> middles;
};

/// Adds the walls of the cut to a split outer surface, which makes it watertight. They are the dual facets of severed
/// axis links, one copy for each cut face, joined to the split line. A wall has its own vertices, so that normals break
/// at the cut edge.
void add_cut_wall(CutVertices& vertices, const SplitLine& split);

}  // namespace ctpm::render
