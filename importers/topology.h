#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/model/vec3.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// Vertices and triangles, nothing promised about them.
struct Soup {
  std::vector<Vec3> vertex;
  std::vector<Triangle> triangle;
};

struct BoundingBox {
  Vec3 least, most;
  Vec3 centre() const { return 0.5 * (least + most); }
  double diagonal() const { return norm(most - least); }
};

/// Bounding box of the vertices that triangles use; a point at 0 if there are none.
BoundingBox bounding_box(const Soup& soup);

/// One vertex per position: vertices in the very same place (distance 0) or within `distance` of an earlier
/// one become that one. Returns how many vertices went. Vertices that no triangle uses go too, uncounted.
std::int64_t weld(Soup& soup, double distance);

/// Drops vertices that no triangle uses; those that were split apart in one place stay apart.
void drop_unused(Soup& soup);

/// Drops triangles that name a vertex twice; returns how many.
std::int64_t drop_collapsed(Soup& soup);

/// Drops triangles that have the same three vertices as an earlier one, in whatever order; returns how many.
std::int64_t drop_duplicates(Soup& soup);

/// All edges, the smaller vertex in the upper half, each with a triangle it belongs to; equal edges side by
/// side.
std::vector<std::pair<std::uint64_t, std::int32_t>> sorted_edges(const std::vector<Triangle>& triangle);

/// Vertices at which fans of triangles touch that no edge joins, in the order of their index.
std::vector<std::int32_t> find_pinched(const Soup& soup);

/// Edges of more than two triangles: the middle of each, in the order of their vertices.
std::vector<Vec3> find_non_manifold_edges(const Soup& soup);

/// Triangles grouped into pieces that are joined by edges; pieces are numbered by their first triangle.
struct Parts {
  std::vector<std::int32_t> of_triangle;  ///< (triangle_count)
  std::int32_t count = 0;
};
Parts find_parts(const std::vector<Triangle>& triangle);

/// How many groups of triangles there are that common vertices join.
std::int64_t count_joined(const std::vector<Triangle>& triangle);

/// Signed volume as seen from `from`: positive for a closed mesh that is oriented outwards.
double signed_volume(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle, Vec3 from);
double surface_area(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

/// How many of `after`'s triangles are triangles of `before` turned round. Vertices are matched by position.
struct Turned {
  std::int64_t turned = 0, kept = 0;
};
Turned count_turned(const Soup& before, const Soup& after);

}  // namespace ctpm::importers
