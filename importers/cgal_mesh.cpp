#include "importers/cgal_mesh.h"

#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>

#include <stdexcept>

namespace ctpm::importers::cgal {

PolygonSoup::PolygonSoup(const Soup& soup) {
  points.reserve(soup.vertex.size());
  for (const Vec3& p : soup.vertex) points.emplace_back(p.x, p.y, p.z);
  polygons.reserve(soup.triangle.size());
  for (const Triangle& t : soup.triangle) polygons.push_back({std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2])});
}

Mesh to_mesh(const PolygonSoup& soup) {
  namespace PMP = CGAL::Polygon_mesh_processing;
  if (!PMP::is_polygon_soup_a_polygon_mesh(soup.polygons))
    throw std::logic_error("an oriented soup is still no manifold mesh");
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, mesh);
  return mesh;
}

Soup to_soup(const Mesh& mesh) {
  Soup soup;
  std::vector<std::int32_t> index(mesh.num_vertices() + mesh.number_of_removed_vertices(), -1);
  for (const auto v : mesh.vertices()) {
    index[std::size_t(v)] = std::int32_t(soup.vertex.size());
    soup.vertex.push_back(from_cgal(mesh.point(v)));
  }
  for (const auto f : mesh.faces()) {
    Triangle triangle{};
    int c = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) triangle[c++ % 3] = index[std::size_t(v)];
    soup.triangle.push_back(triangle);
  }
  return soup;
}

}  // namespace ctpm::importers::cgal
