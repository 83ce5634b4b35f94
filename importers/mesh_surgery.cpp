#include "importers/mesh_surgery.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <vector>

namespace ctpm {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Halfedge = Mesh::Halfedge_index;
using Polygon = std::array<std::size_t, 3>;

Vec3 from_cgal(const Point& p) { return {p.x(), p.y(), p.z()}; }

struct PolygonSoup {
  std::vector<Point> points;
  std::vector<Polygon> polygons;

  explicit PolygonSoup(const Soup& soup) {
    points.reserve(soup.vertex.size());
    for (const Vec3& p : soup.vertex) points.emplace_back(p.x, p.y, p.z);
    polygons.reserve(soup.triangle.size());
    for (const Triangle& t : soup.triangle)
      polygons.push_back({std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2])});
  }
};

Mesh to_mesh(const PolygonSoup& soup) {
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
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
      triangle[c++ % 3] = index[std::size_t(v)];
    soup.triangle.push_back(triangle);
  }
  return soup;
}

Hole measure(const Mesh& mesh, Halfedge border) {
  Hole hole;
  for (const auto h : mesh.halfedges_around_face(border)) {
    hole.centre += from_cgal(mesh.point(mesh.target(h)));
    ++hole.edges;
  }
  hole.centre = hole.centre / double(hole.edges);
  for (const auto h : mesh.halfedges_around_face(border))
    hole.diameter = std::max(hole.diameter, 2 * norm(from_cgal(mesh.point(mesh.target(h))) - hole.centre));
  return hole;
}

/// Closes one border; false if no triangulation of it exists that keeps the mesh manifold.
bool fill_one(Mesh& mesh, Halfedge border) {
  std::vector<Mesh::Face_index> faces;
  std::vector<Mesh::Vertex_index> vertices;
  PMP::triangulate_and_refine_hole(mesh, border, std::back_inserter(faces), std::back_inserter(vertices));
  return !faces.empty();
}

}  // namespace

void orient_and_stitch(Soup& soup) {
  PolygonSoup polygons(soup);
  PMP::orient_polygon_soup(polygons.points, polygons.polygons);
  Mesh mesh = to_mesh(polygons);
  // First within parts, so that a fin on a closed part does not keep its own edges apart; then between parts.
  PMP::stitch_borders(mesh, CGAL::parameters::apply_per_connected_component(true));
  PMP::stitch_borders(mesh);
  PMP::duplicate_non_manifold_vertices(mesh);
  soup = to_soup(mesh);
}

Closing fill_holes(Soup& soup, double largest_hole) {
  Closing closing;
  Mesh mesh = to_mesh(PolygonSoup(soup));
  std::vector<Halfedge> borders;
  PMP::extract_boundary_cycles(mesh, std::back_inserter(borders));
  for (const Halfedge border : borders) {
    const Hole hole = measure(mesh, border);
    if (hole.diameter > largest_hole)
      closing.too_large.push_back(hole);
    else
      (fill_one(mesh, border) ? closing.filled : closing.unfillable).push_back(hole);
  }
  if (!closing.filled.empty()) soup = to_soup(mesh);
  return closing;
}

void orient_parts(Soup& soup) {
  Mesh mesh = to_mesh(PolygonSoup(soup));
  PMP::orient_to_bound_a_volume(mesh);
  soup = to_soup(mesh);
}

}  // namespace ctpm
