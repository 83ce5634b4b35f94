#pragma once

#include "core/cutbody/cut_body.h"

namespace ctpm::fidelity {

/// How the triangles of a drawn surface hang together; vertices of one piece that always move together count as one.
struct Topology {
  int components = 0;
  int open_edges = 0;  ///< of one triangle
};
Topology topology_of(const cutbody::CutBody& drawn);

}  // namespace ctpm::fidelity
