#pragma once

#include <array>

#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// How an organ has moved from rest as a whole: turned about its centre of mass, and moved with it.
struct RigidMotion {
  std::array<double, 9> turn{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< by rows
  Vec3 from, to;                                          ///< centre of mass at rest and now [m]

  /// Where a point of the organ at rest would be [m].
  Vec3 operator()(Vec3 rest) const;
};

/// The rigid motion that is nearest to that of the organ's spheres, by least squares weighted with their masses: the
/// orthogonal part of a polar decomposition, by Newton's method (Higham, "Computing the polar decomposition - with
/// applications", SIAM J. Sci. Stat. Comput. 7, 1986). Without a turn where the spheres do not span space.
RigidMotion rigid_motion(const Model& model, const OrganRange& organ, const Vec3Array& position);

}  // namespace ctpm::surface
