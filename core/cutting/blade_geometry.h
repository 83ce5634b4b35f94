#pragma once

#include <optional>

#include "core/model/box.h"
#include "core/model/vec3.h"

namespace ctpm::cutting {

/// Where a segment p-q crosses the surface that an edge sweeps while it moves from `from`-`to` to `from2`-`to2`: the
/// triangles (from, to, from2) and (to, to2, from2).
struct SweepHit {
  double along;   ///< position along the segment, 0 at p to 1 at q
  double across;  ///< position along the edge, 0 at `from` to 1 at `to`
  double share;   ///< part of the edge's motion, 0 to 1
};

/// Touching an edge or corner of a triangle counts as crossing. An end in the plane of a triangle counts as on that
/// side of it from which its corners run counter-clockwise, so that what lies in the surface belongs to one side.
std::optional<SweepHit> meet_sweep(Vec3 p, Vec3 q, Vec3 from, Vec3 to, Vec3 from2, Vec3 to2);

/// The point of the triangle a b c that is nearest to p.
Vec3 nearest_in_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

using ctpm::Box;

}  // namespace ctpm::cutting
