#pragma once

#include <map>
#include <utility>
#include <vector>

#include "studio/render/cut_vertices.h"

namespace ctpm::render {

/// A side of the split line: an edge of the outer surface where the wall begins, as its outer triangle walks
/// it.
struct Lip {
  CutVertices::Index from, to;
};

/// Where the outer surface was split.
struct SplitLine {
  std::vector<Lip> lips;
  /// (u, v): the copy on u's side of the place where the edge u-v is split.
  std::map<std::pair<CutVertices::Index, CutVertices::Index>, CutVertices::Index> middles;
};

/// Adds the wall of the cut to a split outer surface: the dual facets of severed axis links, one copy for
/// each bank, joined to the lips and closed. The wall has its own vertices, so that normals break at the lip.
void add_cut_wall(CutVertices& vertices, const SplitLine& split);

}  // namespace ctpm::render
