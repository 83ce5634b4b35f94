#include <cmath>
#include <numbers>

#include "importers/mesh.h"

namespace ctpm::importers {
namespace {

struct Angle {
  double sine = 0, cosine = 1;
};

/// In long double, whose functions have one version for all processors, so that the same file gives the same bits on
/// each.
Angle angle_of(double degrees) {
  const long double rest = std::remainder((long double)degrees, 360.0L);
  const long double quarters = rest / 90;
  if (quarters == std::nearbyint(quarters)) {
    constexpr Angle kQuarters[] = {{0, -1}, {-1, 0}, {0, 1}, {1, 0}, {0, -1}};
    return kQuarters[int(quarters) + 2];
  }
  const long double angle = rest / 180 * std::numbers::pi_v<long double>;
  return {double(std::sin(angle)), double(std::cos(angle))};
}

}  // namespace

std::vector<Vec3> turned(std::vector<Vec3> points, Vec3 turn) {
  if (turn == Vec3{}) return points;
  const Angle x = angle_of(turn.x), y = angle_of(turn.y), z = angle_of(turn.z);
  for (Vec3& p : points) {
    p = {p.x, x.cosine * p.y - x.sine * p.z, x.sine * p.y + x.cosine * p.z};
    p = {y.cosine * p.x + y.sine * p.z, p.y, y.cosine * p.z - y.sine * p.x};
    p = {z.cosine * p.x - z.sine * p.y, z.sine * p.x + z.cosine * p.y, p.z};
  }
  return points;
}

}  // namespace ctpm::importers
