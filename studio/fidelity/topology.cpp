#include "studio/fidelity/topology.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/surface/surface.h"
#include "importers/mesh.h"

namespace ctpm::fidelity {

Topology topology_of(const cutbody::CutBody& drawn) {
  const Surface& surface = drawn.surface();
  const std::vector<std::int32_t> place = surface::welded(surface), piece = drawn.piece_of_vertex();
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> number;
  const auto number_of = [&](std::int32_t v) {
    const auto i = std::size_t(v);
    return number.try_emplace({place[i], piece[i]}, v).first->second;
  };
  std::vector<importers::Triangle> triangle;
  for (const auto& t : surface.triangle) {
    const std::int32_t a = number_of(t[0]), b = number_of(t[1]), c = number_of(t[2]);
    if (a != b && b != c && c != a) triangle.push_back({a, b, c});
  }
  const importers::MeshCounts counts = importers::count_mesh(surface.vertex, triangle);
  return {int(counts.parts), int(counts.open_edges)};
}

}  // namespace ctpm::fidelity
