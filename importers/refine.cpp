#include "importers/refine.h"

#include <CGAL/Polygon_mesh_processing/remesh.h>

#include <algorithm>

#include "importers/cgal_mesh.h"

namespace ctpm::importers {
namespace {

/// Whether an edge is longer, or so little shorter that rounding decides.
bool has_edge_longer_than(double longest, const Soup& soup) {
  constexpr double kRounding = 1e-12;
  return std::any_of(soup.triangle.begin(), soup.triangle.end(), [&](const Triangle& t) {
    const auto at = [&](int c) { return soup.vertex[std::size_t(t[c % 3])]; };
    for (int c = 0; c < 3; ++c)
      if (norm(at(c + 1) - at(c)) > (1 - kRounding) * longest) return true;
    return false;
  });
}

}  // namespace

Soup refine(const Soup& soup, double longest) {
  if (!has_edge_longer_than(longest, soup)) return soup;
  cgal::Mesh mesh = cgal::to_mesh(cgal::PolygonSoup(soup));
  CGAL::Polygon_mesh_processing::split_long_edges(mesh.edges(), longest, mesh);
  return cgal::to_soup(mesh);
}

}  // namespace ctpm::importers
