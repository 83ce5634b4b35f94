#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::importers {

/// An organ as an implicit shape, with acceptance bounds for its mesh. z is up; the lowest point is near z = 0.
struct OrganShape {
  /// Closed interval.
  struct Range {
    double low, high;
  };

  std::string name;                         ///< name of the file, without extension
  std::string description;                  ///< one sentence for the file's header
  std::function<double(Vec3)> distance_mm;  ///< approximate signed distance of a point [mm]; negative inside
  Vec3 inside_mm;                           ///< a point well inside
  double reach_mm = 0;                      ///< the shape lies within this distance of `inside_mm`
  double edge_mm = 0;                       ///< edge length of the mesh
  Range triangles{};                        ///< accepted triangle count
  Range volume_ml{};                        ///< accepted volume
  Vec3 size_mm;                             ///< wanted size of the bounding box, to within 3 %
};

/// The liver, the kidney and the piece of skin.
std::vector<OrganShape> organ_shapes();

}  // namespace ctpm::importers
