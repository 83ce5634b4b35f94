#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/model/vec3.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// A tree of boxes over triangles for exact distances. Never changes once built, so threads may share it.
class SurfaceIndex {
 public:
  /// At least one triangle.
  SurfaceIndex(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

  /// The squared distance of the nearest triangle, and where it was found.
  struct Nearest {
    double squared_distance = 0;  ///< [m^2]
    std::int32_t block = 0;       ///< of triangles, in the index's own order; pass it back as `guess`
  };

  /// The distance of `point` from the triangles. `guess`: a triangle that is probably near, which only makes
  /// the search faster.
  Nearest nearest(Vec3 point, std::int32_t guess = 0) const;

 private:
  static constexpr std::int32_t kLanes = 4;
  using Lanes = std::array<double, kLanes>;  ///< one number of each of four things
  struct alignas(16) LanesOfVec3 {
    Lanes x, y, z;
  };

  /// A flat cylinder around triangles, along their mean normal. It hugs a smooth surface far closer than a
  /// box: a point deep inside is about as far from the boxes of very many triangles as from the nearest one.
  struct Disc {
    Vec3 centre, normal;                 ///< [m], unit length
    double half_height = 0, radius = 0;  ///< [m]
  };

  /// Boxes of up to four children, side by side so that they are looked at together, and their discs. Missing
  /// ones are infinitely far.
  struct Node {
    LanesOfVec3 least, most;
    std::array<Disc, kLanes> disc;
    std::array<std::int32_t, kLanes> child;  ///< a node, or ~block of a leaf
  };
  /// Four triangles, side by side; missing ones repeat the last. Corners [m], unit normal, 1 / squared edge
  /// [1/m^2].
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

/// Squared distance of a point from a triangle, edges and corners included.
double squared_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace ctpm::importers
