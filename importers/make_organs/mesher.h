#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/model/result.h"
#include "core/model/vec3.h"
#include "importers/make_organs/shapes.h"

namespace ctpm::importers {

/// A triangle mesh with coordinates in [mm], exactly as stored in the file (three decimals).
struct OrganMesh {
  std::vector<Vec3> vertex_mm;                        ///< (vertex_count)
  std::vector<std::array<std::int32_t, 3>> triangle;  ///< counter-clockwise seen from outside (triangle_count)
};

/// Measurements of a mesh.
struct MeshFacts {
  double volume_ml = 0;
  double area_mm2 = 0;
  double least_angle_deg = 0;  ///< smallest angle of all triangles
  double least_edge_mm = 0, greatest_edge_mm = 0;
  Vec3 low_mm, high_mm;  ///< corners of the bounding box
};

/// Triangulates the shape evenly and places it on the plane z = 0, with the middle of its bounding box over the origin.
/// The same shape gives the same mesh. Error: the mesher found no surface.
Result<OrganMesh> mesh_shape(const OrganShape& shape);

/// Measures the mesh. Errors: not closed, several parts, a tunnel, inside out, self-intersections, a triangle angle of
/// 15 degrees or less, or a count, volume or size outside the shape's bounds.
Result<MeshFacts> check_mesh(const OrganMesh& mesh, const OrganShape& shape);

}  // namespace ctpm::importers
