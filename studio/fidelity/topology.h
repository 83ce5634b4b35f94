#pragma once

#include "core/model/organ.h"

namespace ctpm::fidelity {

/// How the triangles of a surface hang together; vertices that always move together count as one.
struct Topology {
  int components = 0;
  int open_edges = 0;  ///< that belong to more triangles in one direction than in the other
};
Topology topology_of(const Surface& surface);

}  // namespace ctpm::fidelity
