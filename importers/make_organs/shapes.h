#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::importers {

/// An organ as an implicit shape, and what its mesh must look like to be accepted. z is up and the organ lies
/// with its lowest point near z = 0.
struct OrganShape {
  /// Both ends are allowed.
  struct Range {
    double low, high;
  };

  std::string name;                         ///< of the file, without its ending
  std::string description;                  ///< one sentence for the file's head
  std::function<double(Vec3)> distance_mm;  ///< about the signed distance of a point in [mm]; negative inside
  Vec3 inside_mm;                           ///< a point well inside
  double reach_mm = 0;                      ///< the shape lies within this distance of `inside_mm`
  double edge_mm = 0;                       ///< edge length of the mesh
  Range triangles{};                        ///< accepted count
  Range volume_ml{};                        ///< accepted volume
  Vec3 size_mm;                             ///< bounding box wanted; met to 3 %
};

/// The liver, the kidney and the piece of skin.
std::vector<OrganShape> organ_shapes();

}  // namespace ctpm::importers
