#include "studio/fidelity/topology.h"

#include <array>
#include <cstdint>
#include <vector>

#include "core/surface/surface.h"
#include "importers/mesh.h"

namespace ctpm::fidelity {

Topology topology_of(const Surface& surface) {
  const std::vector<std::int32_t> number = surface::welded(surface);
  std::vector<importers::Triangle> triangle;
  for (const auto& t : surface.triangle) {
    const std::int32_t a = number[std::size_t(t[0])], b = number[std::size_t(t[1])], c = number[std::size_t(t[2])];
    if (a != b && b != c && c != a) triangle.push_back({a, b, c});
  }
  const importers::MeshCounts counts = importers::count_mesh(surface.vertex, triangle);
  return {int(counts.parts), int(counts.open_edges)};
}

}  // namespace ctpm::fidelity
