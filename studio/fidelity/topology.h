#pragma once

#include "core/model/organ.h"

namespace ctpm::fidelity {

/// How the triangles of a surface hang together; vertices that always move together count as one.
struct Topology {
  int components = 0;
  int open_edges = 0;  ///< of one triangle
};
Topology topology_of(const Surface& surface);

}  // namespace ctpm::fidelity
