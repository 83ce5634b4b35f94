#pragma once

#include "core/cutting/cutting.h"

namespace ctpm::contact {

/// The motion of a blade over one tick.
struct BladeMotion {
  cutting::BladeEdge from, to;     ///< at the tick's start and end
  Vec3 heading_tip, heading_heel;  ///< direction in which its ends have moved lately, length 0 to 1
};

/// Tows `trail` (2) behind the ends of the blade at a distance of at most Tool::trail_distance, and gives `motion` the
/// heading that follows: hands tremble, and a heading must not.
void tow(const Tool& tool, Vec3Array& trail, BladeMotion& motion);

}  // namespace ctpm::contact
