#pragma once

#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// How far inside an obstacle a point is.
struct Inside {
  double depth;  ///< [m]; negative outside
  Vec3 outward;  ///< shortest way out, unit length
};
Inside find_inside(const Obstacle& obstacle, Vec3 point);

}  // namespace ctpm::surface
