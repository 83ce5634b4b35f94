#pragma once

#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::cutting {

/// Where an organ's lattice is at rest; an organ may be turned in its scene.
struct LatticeFrame {
  Vec3 origin;   ///< of cell 0 0 0 [m]
  Vec3 axis[3];  ///< unit vectors
};

/// The frame of an organ with at least one sphere, from neighbours along each axis. An axis along which it has one
/// layer is perpendicular to the others.
LatticeFrame lattice_frame(const Model& model, const OrganRange& organ);

}  // namespace ctpm::cutting
