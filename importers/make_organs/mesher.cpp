#include "importers/make_organs/mesher.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/facets_in_complex_3_to_triangle_mesh.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace ctpm::importers {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

constexpr unsigned kSeed = 20;  // of the mesher's first points; any value works, but a change moves all vertices
constexpr double kLeastAngleDeg = 15.0;  // smaller angles give fillers and renderers bad normals
constexpr double kSizeTolerance = 0.03;  // the sizes are rounded typical values, not measurements

Vec3 to_vec3(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }
Kernel::Point_3 to_point(Vec3 v) { return {v.x, v.y, v.z}; }

/// Gradient of the shape by central differences.
Vec3 gradient(const OrganShape& shape, Vec3 p) {
  constexpr double h = 1e-4;  // [mm]; far below the finest detail, far above rounding errors
  const auto slope = [&](Vec3 step) { return (shape.distance_mm(p + step) - shape.distance_mm(p - step)) / (2.0 * h); };
  return {slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})};
}

/// Moves a point near the surface onto it by Newton steps along the gradient.
Vec3 onto_surface(const OrganShape& shape, Vec3 p) {
  for (int iteration = 0; iteration < 8; ++iteration) {
    const Vec3 slope = gradient(shape, p);
    p -= (shape.distance_mm(p) / std::max(dot(slope, slope), 1e-6)) * slope;
  }
  return p;
}

/// Delaunay refinement of the implicit surface, finer than the final mesh. Uses Mesh_3, because the older
/// Surface_mesher orders by addresses, so that earlier allocations would change the mesh.
Mesh refine_surface(const OrganShape& shape) {
  using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
  using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
  using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
  namespace named = CGAL::parameters;

  const auto level = [&shape](const Kernel::Point_3& p) { return shape.distance_mm(to_vec3(p)); };
  const Kernel::Sphere_3 bound(to_point(shape.inside_mm), shape.reach_mm * shape.reach_mm);
  CGAL::Random random(kSeed);
  const auto domain = Domain::create_implicit_mesh_domain(named::function = level, named::bounding_object = bound,
                                                          named::p_rng = &random, named::relative_error_bound = 1e-6);
  const Criteria criteria(named::facet_angle = 28.0, named::facet_size = 0.4 * shape.edge_mm,
                          named::facet_distance = 0.05 * shape.edge_mm);
  const auto complex = CGAL::make_mesh_3<CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>>(
      domain, criteria, named::no_perturb(), named::no_exude(), named::manifold());

  Mesh mesh;
  CGAL::facets_in_complex_3_to_triangle_mesh(complex, mesh);
  return mesh;
}

/// Remeshes to even triangles of the wanted edge length, with vertices on the implicit surface.
void even_out(Mesh& mesh, const OrganShape& shape) {
  pmp::isotropic_remeshing(faces(mesh), shape.edge_mm, mesh,
                           pmp::parameters::number_of_iterations(12).number_of_relaxation_steps(3));
  mesh.collect_garbage();
  for (const auto v : mesh.vertices()) mesh.point(v) = to_point(onto_surface(shape, to_vec3(mesh.point(v))));
}

OrganMesh plain_mesh(const Mesh& mesh) {
  OrganMesh plain;
  for (const auto v : mesh.vertices()) plain.vertex_mm.push_back(to_vec3(mesh.point(v)));
  for (const auto f : mesh.faces()) {
    std::array<std::int32_t, 3> corner{};
    std::size_t next = 0;
    for (const auto v : vertices_around_face(mesh.halfedge(f), mesh)) corner[next++] = std::int32_t(v.idx());
    plain.triangle.push_back(corner);
  }
  return plain;
}

Mesh cgal_mesh(const OrganMesh& plain) {
  Mesh mesh;
  for (const Vec3 v : plain.vertex_mm) mesh.add_vertex(to_point(v));
  for (const auto& t : plain.triangle)
    mesh.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2]));
  return mesh;
}

struct Box {
  Vec3 low, high;
};
Box bounding_box(const std::vector<Vec3>& points) {
  Box box{points.front(), points.front()};
  for (const Vec3 p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

/// Translation from shape to file coordinates: lowest point on z = 0, middle over the origin.
Vec3 resting_shift(const std::vector<Vec3>& points) {
  const Box box = bounding_box(points);
  return {-0.5 * (box.low.x + box.high.x), -0.5 * (box.low.y + box.high.y), -box.low.z};
}

double rounded(double value_mm) { return std::round(value_mm * 1000.0) / 1000.0 + 0.0; }

/// Shortest and longest edge, smallest angle.
void measure_triangles(const OrganMesh& mesh, MeshFacts& facts) {
  facts.least_angle_deg = 180.0;
  facts.least_edge_mm = 1e300;
  for (const auto& t : mesh.triangle) {
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3 p = mesh.vertex_mm[t[corner]];
      const Vec3 to_next = mesh.vertex_mm[t[(corner + 1) % 3]] - p;
      const Vec3 to_last = mesh.vertex_mm[t[(corner + 2) % 3]] - p;
      const double angle = std::atan2(norm(cross(to_next, to_last)), dot(to_next, to_last));
      facts.least_angle_deg = std::min(facts.least_angle_deg, angle * 180.0 / std::numbers::pi);
      facts.least_edge_mm = std::min(facts.least_edge_mm, norm(to_next));
      facts.greatest_edge_mm = std::max(facts.greatest_edge_mm, norm(to_next));
    }
  }
}

std::string out_of(const char* what, double got, OrganShape::Range range) {
  return std::string(what) + " is " + std::to_string(got) + ", must be in [" + std::to_string(range.low) + ", " +
         std::to_string(range.high) + "]";
}

}  // namespace

Result<OrganMesh> mesh_shape(const OrganShape& shape) {
  Mesh mesh = refine_surface(shape);
  if (mesh.number_of_faces() == 0) return Error{shape.name, "the mesher found no surface", "check inside_mm"};
  even_out(mesh, shape);
  if (CGAL::is_closed(mesh) && !pmp::is_outward_oriented(mesh)) pmp::reverse_face_orientations(mesh);

  OrganMesh plain = plain_mesh(mesh);
  const Vec3 shift = resting_shift(plain.vertex_mm);
  for (Vec3& v : plain.vertex_mm) v = {rounded(v.x + shift.x), rounded(v.y + shift.y), rounded(v.z + shift.z)};
  return plain;
}

Result<MeshFacts> check_mesh(const OrganMesh& plain, const OrganShape& shape) {
  Errors errors;
  const auto complain = [&](std::string message) { errors.push_back({shape.name, std::move(message), ""}); };
  const auto require = [&](const char* what, double got, OrganShape::Range range) {
    if (!(got >= range.low && got <= range.high)) complain(out_of(what, got, range));
  };

  // Check topology first: the rest is defined only for one closed mesh.
  const Mesh mesh = cgal_mesh(plain);
  if (mesh.number_of_faces() != plain.triangle.size()) complain("some edges have more than two triangles");
  if (!CGAL::is_valid_polygon_mesh(mesh)) complain("the mesh is not manifold");
  if (!CGAL::is_closed(mesh)) complain("the mesh is not closed");
  if (!errors.empty()) return errors;
  std::vector<std::size_t> part(mesh.number_of_faces());
  const auto part_of_face = CGAL::make_property_map(part);
  if (pmp::connected_components(mesh, part_of_face) != 1) complain("the mesh has several parts");
  // Euler: vertices - edges + faces = 2 for a mesh without tunnels.
  if (mesh.number_of_vertices() + mesh.number_of_faces() != mesh.number_of_edges() + 2)
    complain("the mesh has a tunnel");
  if (pmp::does_self_intersect(mesh)) complain("the mesh cuts itself");
  if (!pmp::is_outward_oriented(mesh)) complain("the mesh is inside out");

  MeshFacts facts;
  measure_triangles(plain, facts);
  const Box box = bounding_box(plain.vertex_mm);
  facts.low_mm = box.low;
  facts.high_mm = box.high;
  facts.volume_ml = CGAL::to_double(pmp::volume(mesh)) / 1000.0;
  facts.area_mm2 = CGAL::to_double(pmp::area(mesh));

  if (!(facts.least_angle_deg > kLeastAngleDeg))
    complain(out_of("smallest angle [deg]", facts.least_angle_deg, {kLeastAngleDeg, 60}));
  require("triangle count", double(plain.triangle.size()), shape.triangles);
  require("volume [ml]", facts.volume_ml, shape.volume_ml);
  const auto require_size = [&](const char* what, double got, double wanted) {
    require(what, got, {wanted * (1.0 - kSizeTolerance), wanted * (1.0 + kSizeTolerance)});
  };
  require_size("size in x [mm]", box.high.x - box.low.x, shape.size_mm.x);
  require_size("size in y [mm]", box.high.y - box.low.y, shape.size_mm.y);
  require_size("size in z [mm]", box.high.z - box.low.z, shape.size_mm.z);
  if (!errors.empty()) return errors;
  return facts;
}

}  // namespace ctpm::importers
