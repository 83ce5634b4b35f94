#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/model/vec3.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// Vertices and triangles without any guarantee.
struct Soup {
  std::vector<Vec3> vertex;
  std::vector<Triangle> triangle;
};

struct BoundingBox {
  Vec3 least, most;
  Vec3 centre() const { return 0.5 * (least + most); }
  double diagonal() const { return norm(most - least); }
};

/// Bounding box of the vertices that triangles use; the point 0 if there are none.
BoundingBox bounding_box(const Soup& soup);

/// Merges each vertex with an earlier one within `distance` [m]; at distance 0, positions must be equal. Returns the
/// number of vertices merged. Also drops unused vertices, uncounted.
std::int64_t weld(Soup& soup, double distance);

/// Drops vertices that no triangle uses. Split vertices at one position stay separate.
void drop_unused(Soup& soup);

/// Drops triangles that use a vertex twice; returns how many.
std::int64_t drop_collapsed(Soup& soup);

/// Drops triangles with the same three vertices as an earlier one, in any order; returns how many.
std::int64_t drop_duplicates(Soup& soup);

/// All edges as sorted keys (smaller vertex in the upper 32 bits), each with a triangle that it belongs to. Equal edges
/// are adjacent.
std::vector<std::pair<std::uint64_t, std::int32_t>> sorted_edges(const std::vector<Triangle>& triangle);

/// Whether every edge has two triangles, which run along it in opposite directions.
bool is_closed_and_oriented(const std::vector<Triangle>& triangle);

/// Vertices where fans of triangles touch without a common edge, by ascending index.
std::vector<std::int32_t> find_pinched(const Soup& soup);

/// Midpoints of edges with more than two triangles, ordered by their vertices.
std::vector<Vec3> find_non_manifold_edges(const Soup& soup);

/// Edge-connected parts of the triangles, numbered by their first triangle.
struct Parts {
  std::vector<std::int32_t> of_triangle;  ///< (triangle_count)
  std::int32_t count = 0;
};
Parts find_parts(const std::vector<Triangle>& triangle);

/// Number of vertex-connected groups of triangles.
std::int64_t count_joined(const std::vector<Triangle>& triangle);

/// Signed volume relative to the point `from` [m^3]: positive for a closed mesh that is oriented outwards.
double signed_volume(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle, Vec3 from);
double surface_area(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

/// Counts triangles of `after` that are flipped triangles of `before`. Vertices are matched by position.
struct Turned {
  std::int64_t turned = 0, kept = 0;
};
Turned count_turned(const Soup& before, const Soup& after);

}  // namespace ctpm::importers
