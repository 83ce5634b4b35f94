#include "importers/mesh_surgery.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "importers/cgal_mesh.h"

namespace ctpm::importers {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using cgal::from_cgal;
using cgal::Mesh;
using cgal::PolygonSoup;
using cgal::to_mesh;
using cgal::to_soup;
using Halfedge = Mesh::Halfedge_index;

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

/// Fills one hole. False if no triangulation keeps the mesh manifold.
bool fill_one(Mesh& mesh, Halfedge border) {
  std::vector<Mesh::Face_index> faces;
  std::vector<Mesh::Vertex_index> vertices;
  PMP::triangulate_and_refine_hole(mesh, border, std::back_inserter(faces), std::back_inserter(vertices));
  return !faces.empty();
}

}  // namespace

void orient_and_stitch(Soup& soup) {
  // Most meshes are what they should be.
  if (is_closed_and_oriented(soup.triangle) && find_pinched(soup).empty()) return;
  PolygonSoup polygons(soup);
  PMP::orient_polygon_soup(polygons.points, polygons.polygons);
  Mesh mesh = to_mesh(polygons);
  // Stitch first within parts, so that a fin on a closed part does not keep its own edges apart, then between parts.
  PMP::stitch_borders(mesh, CGAL::parameters::apply_per_connected_component(true));
  PMP::stitch_borders(mesh);
  PMP::duplicate_non_manifold_vertices(mesh);
  soup = to_soup(mesh);
}

Closing fill_holes(Soup& soup, double largest_hole) {
  Closing closing;
  if (is_closed_and_oriented(soup.triangle)) return closing;
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

}  // namespace ctpm::importers
