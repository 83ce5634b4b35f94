#include "core/surface/rigid_motion.h"

#include <cmath>

namespace ctpm::surface {
namespace {

using Matrix = std::array<double, 9>;

/// Transposed inverse times the determinant, and the determinant.
std::pair<Matrix, double> cofactors(const Matrix& m) {
  const Vec3 x{m[0], m[1], m[2]}, y{m[3], m[4], m[5]}, z{m[6], m[7], m[8]};
  const Vec3 a = cross(y, z), b = cross(z, x), c = cross(x, y);
  return {{a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}, dot(x, a)};
}

double size_squared(const Matrix& m) {
  double sum = 0;
  for (const double entry : m) sum += entry * entry;
  return sum;
}

/// The rotation nearest to `m`; none if `m` is nearly singular or turns space inside out.
Matrix nearest_rotation(Matrix m) {
  constexpr int kMostIterations = 30;
  constexpr double kSingular = 1e-6, kConverged = 1e-28;
  const Matrix none = RigidMotion{}.turn;
  const double size = std::sqrt(size_squared(m));
  if (!(cofactors(m).second > kSingular * size * size * size)) return none;
  for (double& entry : m) entry *= 1.7320508075688772 / size;
  for (int i = 0; i < kMostIterations; ++i) {
    const auto [cofactor, determinant] = cofactors(m);
    Matrix change;
    for (std::size_t k = 0; k < 9; ++k) change[k] = 0.5 * (cofactor[k] / determinant - m[k]);
    for (std::size_t k = 0; k < 9; ++k) m[k] += change[k];
    if (size_squared(change) < kConverged) break;
  }
  return m;
}

}  // namespace

Vec3 RigidMotion::operator()(Vec3 rest) const {
  const Vec3 d = rest - from;
  return to + Vec3{turn[0] * d.x + turn[1] * d.y + turn[2] * d.z, turn[3] * d.x + turn[4] * d.y + turn[5] * d.z,
                   turn[6] * d.x + turn[7] * d.y + turn[8] * d.z};
}

RigidMotion rigid_motion(const Model& model, const OrganRange& organ, const Vec3Array& position) {
  RigidMotion motion;
  double mass = 0;
  const auto first = std::size_t(organ.first), last = first + std::size_t(organ.count);
  for (std::size_t i = first; i < last; ++i) {
    mass += model.mass[i];
    motion.from += model.mass[i] * model.rest_position[i], motion.to += model.mass[i] * position[i];
  }
  motion.from = motion.from / mass, motion.to = motion.to / mass;
  Matrix moment{};
  for (std::size_t i = first; i < last; ++i) {
    const Vec3 now = model.mass[i] * (position[i] - motion.to), rest = model.rest_position[i] - motion.from;
    const double of_now[3] = {now.x, now.y, now.z}, of_rest[3] = {rest.x, rest.y, rest.z};
    for (std::size_t k = 0; k < 9; ++k) moment[k] += of_now[k / 3] * of_rest[k % 3];
  }
  motion.turn = nearest_rotation(moment);
  return motion;
}

}  // namespace ctpm::surface
