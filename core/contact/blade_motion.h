#pragma once

#include "core/cutting/cutting.h"

namespace ctpm::contact {

/// The motion of a blade over one tick.
struct BladeMotion {
  cutting::BladeEdge from, to;     ///< at the tick's start and end
  Vec3 heading_tip, heading_heel;  ///< recent direction of motion of each end, length 0 to 1
};

/// Tows the two points of `trail` behind the ends of the blade, at a distance of at most Tool::trail_distance, and sets
/// the heading of `motion`. This filters the tremor of the hand out of the heading.
void tow(const Tool& tool, Vec3Array& trail, BladeMotion& motion);

}  // namespace ctpm::contact
