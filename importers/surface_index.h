#pragma once

#include <cstdint>
#include <vector>

#include "core/vec3.h"
#include "importers/mesh.h"

namespace ctpm {

/// A tree of boxes over triangles for exact distances. Never changes once built, so threads may share it.
class SurfaceIndex {
 public:
  /// At least one triangle.
  SurfaceIndex(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle);

  /// A triangle and its squared distance from a point.
  struct Nearest {
    double squared_distance = 0;  ///< [m^2]
    std::int32_t triangle = -1;   ///< position in the index's own order; pass it back as `guess`
  };

  /// The triangle nearest to `point`. `guess`: a triangle that is probably near, which only makes the search
  /// faster.
  Nearest nearest(Vec3 point, std::int32_t guess = 0) const;

 private:
  struct Node {
    double least[3], most[3];
    std::int32_t
        first;  ///< leaf: its first triangle; else its second child (the first child is the next node)
    std::int32_t count;  ///< triangles of a leaf; 0: not a leaf
  };
  struct Corners {
    Vec3 a, b, c;
  };

  void build(std::vector<std::int32_t>& order, const std::vector<Vec3>& middle, std::int32_t begin,
             std::int32_t end, const std::vector<Corners>& corners);

  std::vector<Node> nodes_;
  std::vector<Corners> triangles_;
};

/// Squared distance of a point from a triangle, edges and corners included.
double squared_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace ctpm
