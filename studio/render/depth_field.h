#pragma once

#include <array>
#include <vector>

#include "core/model/organ.h"
#include "core/model/vec3.h"

namespace ctpm::render {

/// Distances of places at rest from an organ's surface, on a grid. What is outside the organ is not told apart.
struct DepthField {
  Vec3 low, size;              ///< of the box that the texture of `count` covers [m]
  std::array<int, 3> count{};  ///< values along x, y, z, each in the middle of a cell
  std::vector<float> depth;    ///< [m], up to `reach`; x runs fastest

  /// `reach` [m], > 0: how deep is told. `detail` [m], > 0: the thickness of what must be told apart.
  DepthField(const Surface& surface, double reach, double detail);
  DepthField() = default;
};

}  // namespace ctpm::render
