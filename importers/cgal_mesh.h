#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cstddef>
#include <vector>

#include "core/model/vec3.h"
#include "importers/topology.h"

namespace ctpm::importers::cgal {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Polygon = std::array<std::size_t, 3>;

/// A triangle soup in CGAL's types.
struct PolygonSoup {
  std::vector<Point> points;
  std::vector<Polygon> polygons;

  explicit PolygonSoup(const Soup& soup);
};

/// Faces and vertices keep their index. Throws std::logic_error if the soup is not manifold and oriented.
Mesh to_mesh(const PolygonSoup& soup);
Soup to_soup(const Mesh& mesh);

inline Vec3 from_cgal(const Point& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace ctpm::importers::cgal
