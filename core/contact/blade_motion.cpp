#include "core/contact/blade_motion.h"

namespace ctpm {

void tow(const Tool& tool, Vec3Array& trail, BladeMotion& motion) {
  const auto tow_one = [&](std::size_t i, Vec3 end) {
    const Vec3 way = end - trail[i];
    const double length = norm(way);
    if (length <= tool.trail_distance) return way / tool.trail_distance;
    trail.set(i, end - tool.trail_distance / length * way);
    return way / length;
  };
  motion.heading_tip = tow_one(0, motion.to.tip), motion.heading_heel = tow_one(1, motion.to.heel);
}

}  // namespace ctpm
