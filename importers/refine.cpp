#include "importers/refine.h"

#include <CGAL/Polygon_mesh_processing/remesh.h>

#include "importers/cgal_mesh.h"

namespace ctpm::importers {

Soup refine(const Soup& soup, double longest) {
  cgal::Mesh mesh = cgal::to_mesh(cgal::PolygonSoup(soup));
  CGAL::Polygon_mesh_processing::split_long_edges(mesh.edges(), longest, mesh);
  return cgal::to_soup(mesh);
}

}  // namespace ctpm::importers
