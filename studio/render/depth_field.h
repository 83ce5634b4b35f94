#pragma once

#include <array>
#include <vector>

#include "core/model/organ.h"
#include "core/model/vec3.h"

namespace ctpm::render {

/// How deep places at rest are below an organ's surface, on a grid. Outside the organ they are negative, so that
/// between the values what is thinner than the grid is found too; where the surface is not closed they are distances.
struct DepthField {
  Vec3 low, size;              ///< of the box that the texture of `count` covers [m]
  std::array<int, 3> count{};  ///< values along x, y, z, each in the middle of a cell
  std::vector<float> depth;    ///< [m], up to about `reach`; x runs fastest

  /// `reach` [m], > 0: how deep is told. `detail` [m], > 0: the thickness of what must be told apart.
  DepthField(const Surface& surface, double reach, double detail);
  DepthField() = default;

 private:
  void find_outside(const Surface& surface, double step);
};

}  // namespace ctpm::render
