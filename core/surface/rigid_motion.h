#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::surface {

/// A rotation, by rows.
struct Turn {
  std::array<double, 9> entry{1, 0, 0, 0, 1, 0, 0, 0, 1};

  Vec3 operator()(Vec3 v) const;
};

/// How tissue has moved from rest as a whole: turned about its centre of mass, and moved with it.
struct RigidMotion {
  Turn turn;
  Vec3 from, to;  ///< centre of mass at rest and now [m]

  /// Where a point at rest would be [m].
  Vec3 operator()(Vec3 rest) const;
};

/// Adds the outer product of where something is and where it is at rest to a matrix by rows.
void add_moment(std::array<double, 9>& moment, Vec3 now, Vec3 rest);

/// The rotation nearest to a moment, which may be of lower rank.
Turn turn_of(const std::array<double, 9>& moment);

/// The rigid motion that is nearest to that of some spheres, by least squares weighted with their masses: the
/// orthogonal part of a polar decomposition, by Newton's method (Higham, "Computing the polar decomposition - with
/// applications", SIAM J. Sci. Stat. Comput. 7, 1986). Without a turn where the spheres do not span space.
RigidMotion rigid_motion(const Model& model, std::span<const std::int32_t> spheres, const Vec3Array& position);

/// Of how a frame's spheres have moved: the sum of the outer products of their arms now, by weight, and at rest.
/// `position(sphere)`: where a sphere of the frame is [m].
template <class Position>
std::array<double, 9> moment_of(const TissueFrame& frame, Position&& position) {
  Vec3 mean;
  for (std::size_t i = 0; i < frame.sphere.size(); ++i) mean += frame.weight[i] * position(frame.sphere[i]);
  std::array<double, 9> moment{};
  for (std::size_t i = 0; i < frame.sphere.size(); ++i)
    add_moment(moment, frame.weight[i] * (position(frame.sphere[i]) - mean), frame.arm[i]);
  return moment;
}

/// How a frame has turned: the rotation nearest to how its spheres' arms have moved, by least squares. In a plane its
/// normal turns with it, on a line the turn is the smallest, and one sphere does not turn. (Müller, Heidelberger,
/// Teschner and Gross, "Meshless deformations based on shape matching", ACM Trans. Graph. 24, 2005.)
template <class Position>
Turn turn_of(const TissueFrame& frame, Position&& position) {
  return turn_of(moment_of(frame, position));
}

/// How fast a frame turns at most: while none of its spheres moves farther than `reach` [m], what turns with it moves
/// by no more than `rate` [1/m] times as far, times its own length. The turn is the orthogonal factor of a matrix, and
/// changes by no more than the matrix times 2 over the sum of the least singular values of both (Li, "New perturbation
/// bounds for the unitary polar factor", SIAM J. Matrix Anal. Appl. 16, 1995). `reach` is 0 where that says nothing:
/// on a line, or where tissue is crushed.
struct TurnBound {
  double rate = 0, reach = 0;
};
TurnBound bound_turn(const TissueFrame& frame, const std::array<double, 9>& moment);

}  // namespace ctpm::surface
