#include "importers/coarsen.h"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "importers/cgal_mesh.h"

namespace ctpm::importers {

Soup coarsen(const Soup& soup, std::int64_t most_triangles) {
  namespace SMS = CGAL::Surface_mesh_simplification;
  cgal::Mesh mesh = cgal::to_mesh(cgal::PolygonSoup(soup));
  // A closed mesh has three edges per two triangles. The collapse stops below this number of edges.
  const std::size_t fewest_edges = std::size_t(most_triangles / 2 * 3) + 1;
  SMS::edge_collapse(mesh, SMS::Count_stop_predicate<cgal::Mesh>(fewest_edges),
                     CGAL::parameters::filter(SMS::Bounded_normal_change_filter<>()));
  return cgal::to_soup(mesh);
}

}  // namespace ctpm::importers
