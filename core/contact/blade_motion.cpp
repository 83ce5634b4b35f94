#include "core/contact/blade_motion.h"

namespace ctpm::contact {

void tow(const Tool& tool, Vec3Array& trail, BladeMotion& motion) {
  const auto tow_one = [&](std::size_t i, Vec3 end) {
    const Vec3 path = end - trail[i];
    const double length = norm(path);
    if (length <= tool.trail_distance) return path / tool.trail_distance;
    trail.set(i, end - tool.trail_distance / length * path);
    return path / length;
  };
  motion.heading_tip = tow_one(0, motion.to.tip), motion.heading_heel = tow_one(1, motion.to.heel);
}

}  // namespace ctpm::contact
