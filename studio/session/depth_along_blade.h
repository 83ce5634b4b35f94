#pragma once

#include <cstddef>
#include <vector>

#include "core/cutting/tissue_depth.h"
#include "core/model/vec3.h"

namespace ctpm::session {

/// Places of an edge in the tissue at rest, from that nearest to the tip to that nearest to the heel [m].
struct EdgePlaces {
  std::vector<Vec3> place;
  bool from_tip = false;  ///< the first is the tip
};

/// How deep an edge is in an organ along the blade, in the tissue at rest [m]: the length of the straight line from the
/// deepest place that is inside to where the edge leaves the organ towards the handle; a cavity between them counts.
/// The deepest place is the tip, or in a cut through the organ the place where the edge leaves it towards the tip.
/// Where even the last place is inside, because the blade is in there to its heel or the tissue above was cut before,
/// the line goes on to the next surface. Its direction is `way`, the line from the deepest place to the last one. Few
/// places tell it badly, as the tissue holds the tip back: they go on along the `way` of an earlier call that was
/// longer, if they lie on it but for that. 0 where nothing is inside.
double depth_along_blade(const cutting::TissueDepth& tissue, std::size_t organ, const EdgePlaces& edge, Vec3& way);

}  // namespace ctpm::session
