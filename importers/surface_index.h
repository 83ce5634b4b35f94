#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/model/vec3.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// A bounding volume tree over triangles for exact distances. It is immutable, so threads may share it.
class SurfaceIndex {
 public:
  /// Needs at least one triangle.
  SurfaceIndex(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

  /// Squared distance to the nearest triangle, and the block that holds it.
  struct Nearest {
    double squared_distance = 0;  ///< [m^2]
    std::int32_t block = 0;       ///< block of triangles, in the index's own order; pass it back as `guess`
  };

  /// Distance from `point` to the triangles. `guess` is a block that is probably near; it only makes the search faster.
  Nearest nearest(Vec3 point, std::int32_t guess = 0) const;

 private:
  static constexpr std::int32_t kLanes = 4;
  using Lanes = std::array<double, kLanes>;  ///< one number of each of four items
  struct alignas(16) LanesOfVec3 {
    Lanes x, y, z;
  };

  /// A flat cylinder around triangles, along their mean normal. It bounds a smooth surface far more tightly than a box.
  /// For a point deep inside, box distances hardly differ between very many triangles.
  struct Disc {
    Vec3 centre, normal;                 ///< [m], unit length
    double half_height = 0, radius = 0;  ///< [m]
  };

  /// Boxes and discs of up to four children, stored as lanes and tested together. Missing children are infinitely far.
  struct Node {
    LanesOfVec3 least, most;
    std::array<Disc, kLanes> disc;
    std::array<std::int32_t, kLanes> child;  ///< a node, or ~block of a leaf
  };
  /// Four triangles as lanes; missing ones repeat the last. Corners [m], unit normals, 1 / squared edge length [1/m^2].
  struct Block {
    LanesOfVec3 a, b, c, normal;
    Lanes inverse_ab, inverse_bc, inverse_ca;
  };
  struct Builder;

  static Block make_block(const std::vector<std::array<Vec3, 3>>& corners, const std::int32_t* triangle,
                          std::int32_t count);
  static Lanes squared_distances(const Block& block, Vec3 point);
  static Lanes squared_distances(const Node& node, Vec3 point);
  static double squared_distance_from(const Disc& disc, Vec3 point);

  std::vector<Node> nodes_;
  std::vector<Block> blocks_;
};

/// Squared distance from a point to a triangle, edges and corners included [m^2].
double squared_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace ctpm::importers
