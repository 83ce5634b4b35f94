#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/model/box.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// How far inside something rigid a point is.
struct Inside {
  double depth;  ///< [m]; negative outside
  Vec3 outward;  ///< shortest way out, unit length
};

/// A closed mesh that never moves, with a tree of boxes over its triangles. The nearest point of the mesh says how far
/// away a point is, and the pseudonormal there on which side (Baerentzen & Aanaes, "Signed distance computation using
/// the angle weighted pseudonormal", IEEE Trans. Vis. Comput. Graph. 11, 2005).
class RigidMesh {
 public:
  using Triangle = std::array<std::int32_t, 3>;

  RigidMesh() = default;
  /// `triangle`: counter-clockwise seen from outside, with indices of `vertex` [m]. Those without an area are left out.
  RigidMesh(std::vector<Vec3> vertex, const std::vector<Triangle>& triangle);

  bool empty() const { return triangle_.empty(); }
  const Box& box() const { return nodes_.front().box; }  ///< contains the mesh [m]

  /// How far inside a point is; the mesh must not be empty.
  Inside inside(Vec3 point) const;

 private:
  /// A box over triangles [first, last); the first child follows it.
  struct Node {
    Box box{Vec3{}};
    std::int32_t first, last;
    std::int32_t second_child;  ///< -1: a leaf
  };
  /// The nearest point of a triangle, and on which of its features that is: 0 its face, 1 to 3 its edges from corner 0,
  /// 1, 2 on, 4 to 6 its corners.
  struct Nearest {
    Vec3 point;
    std::int32_t feature;
  };

  Vec3 corner(std::int32_t triangle, std::size_t c) const {
    return vertex_[std::size_t(triangle_[std::size_t(triangle)][c])];
  }
  Vec3 middle(std::int32_t triangle) const {
    return (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3;
  }
  std::int32_t build(std::vector<std::int32_t>& order, std::int32_t first, std::int32_t last);
  void find_normals();
  Nearest nearest_of(std::int32_t triangle, Vec3 point) const;

  std::vector<Vec3> vertex_;
  std::vector<Triangle> triangle_;            ///< in the order of the tree's leaves
  std::vector<std::array<Vec3, 7>> normals_;  ///< of each triangle's features
  std::vector<Node> nodes_;
};

}  // namespace ctpm::surface
