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

/// Adds the outer product of where something is and where it is at rest to a matrix by rows.
void add_moment(std::array<double, 9>& moment, Vec3 now, Vec3 rest);

/// A vector at rest, turned by the rotation nearest to a moment, which may be of lower rank.
Vec3 turn_of(const std::array<double, 9>& moment, Vec3 rest);

/// The rigid motion that is nearest to that of the organ's spheres, by least squares weighted with their masses: the
/// orthogonal part of a polar decomposition, by Newton's method (Higham, "Computing the polar decomposition - with
/// applications", SIAM J. Sci. Stat. Comput. 7, 1986). Without a turn where the spheres do not span space.
RigidMotion rigid_motion(const Model& model, const OrganRange& organ, const Vec3Array& position);

/// The offset as the spheres have turned [m]: the rotation nearest to how their arms have moved, by least squares. In a
/// plane its normal turns with it, on a line the turn is the smallest, and one sphere does not turn. (Müller,
/// Heidelberger, Teschner and Gross, "Meshless deformations based on shape matching", ACM Trans. Graph. 24, 2005.)
/// `position(sphere)`: where a sphere of the offset is [m].
template <class Position>
Vec3 turned(const TurnedOffset& offset, Position&& position) {
  Vec3 mean;
  for (std::size_t i = 0; i < offset.sphere.size(); ++i) mean += offset.weight[i] * position(offset.sphere[i]);
  std::array<double, 9> moment{};
  for (std::size_t i = 0; i < offset.sphere.size(); ++i)
    add_moment(moment, offset.weight[i] * (position(offset.sphere[i]) - mean), offset.arm[i]);
  return turn_of(moment, offset.offset);
}

}  // namespace ctpm::surface
