#include "core/surface/rigid_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

/// Cofactors of a moment that are smaller than this, to the square of its size, count as those of a line.
constexpr double kLine = 1e-3;

/// A moment to which, where it is one of a plane, the normal is added: there the cofactors are the outer product of the
/// plane's normals now and at rest. `cofactor`: of the moment; `plane`: its size.
Matrix with_normal(Matrix moment, const Matrix& cofactor, double plane) {
  for (std::size_t k = 0; k < 9; ++k) moment[k] += cofactor[k] / std::sqrt(plane);
  return moment;
}

/// The rotation nearest to `m`; none if `m` is nearly singular or turns space inside out.
Matrix nearest_rotation(Matrix m) {
  constexpr int kMostIterations = 30;
  constexpr double kSingular = 1e-6, kConverged = 1e-28;
  const Matrix none = Turn{}.entry;
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

/// The vector after the smallest rotation that takes the direction `from` to the direction `to`, both unit vectors.
Vec3 turned_least(Vec3 from, Vec3 to, Vec3 v) {
  constexpr double kOpposite = 1e-9;
  const Vec3 axis = cross(from, to);
  const double cosine = dot(from, to);
  if (1 + cosine > kOpposite) return v + cross(axis, v) + cross(axis, cross(axis, v)) / (1 + cosine);
  // Half a turn about any axis across.
  const Vec3 across = std::abs(from.x) < 0.6 ? cross(from, {1, 0, 0}) : cross(from, {0, 1, 0});
  return 2 * (dot(across, v) / dot(across, across)) * across - v;
}

}  // namespace

Vec3 Turn::operator()(Vec3 v) const {
  const Matrix& m = entry;
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
          m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

Vec3 RigidMotion::operator()(Vec3 rest) const { return to + turn(rest - from); }

void add_moment(Matrix& moment, Vec3 now, Vec3 rest) {
  const double of_now[3] = {now.x, now.y, now.z}, of_rest[3] = {rest.x, rest.y, rest.z};
  for (std::size_t k = 0; k < 9; ++k) moment[k] += of_now[k / 3] * of_rest[k % 3];
}

Turn turn_of(const Matrix& moment) {
  const double squared = size_squared(moment);
  if (!(squared > 0)) return {};
  const Matrix cofactor = cofactors(moment).first;
  const double plane = std::sqrt(size_squared(cofactor));
  if (plane > kLine * squared) return {nearest_rotation(with_normal(moment, cofactor, plane))};
  const Vec3 column[3] = {
      {moment[0], moment[3], moment[6]}, {moment[1], moment[4], moment[7]}, {moment[2], moment[5], moment[8]}};
  Vec3 to = column[0];
  for (const Vec3& c : column)
    if (dot(c, c) > dot(to, to)) to = c;
  const Vec3 from{dot(column[0], to), dot(column[1], to), dot(column[2], to)};
  Turn turn;
  const Vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3 v = turned_least(from / norm(from), to / norm(to), axis[a]);
    turn.entry[a] = v.x, turn.entry[3 + a] = v.y, turn.entry[6 + a] = v.z;
  }
  return turn;
}

TurnBound bound_turn(const TissueFrame& frame, const Matrix& moment) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kFlat = 1e-4;  // determinant of a matrix that is far from singular, to the cube of its size
  // The moment changes by no more than `arms` times how far the farthest sphere moves.
  double arms = 0;
  Vec3 mean;
  for (std::size_t i = 0; i < frame.arm.size(); ++i)
    arms += frame.weight[i] * norm(frame.arm[i]), mean += frame.weight[i] * frame.arm[i];
  arms += norm(mean);
  if (!(arms > 0)) return {0, kInfinite};
  const Matrix cofactor = cofactors(moment).first;
  const double size = std::sqrt(size_squared(moment)), plane = std::sqrt(size_squared(cofactor));
  if (!(plane > 4 * kLine * size * size)) return {};
  const Matrix full = with_normal(moment, cofactor, plane);
  const auto [of_full, determinant] = cofactors(full);
  const double whole = std::sqrt(size_squared(full));
  if (!(determinant > kFlat * whole * whole * whole)) return {};
  const double least = determinant / std::sqrt(size_squared(of_full));  // no singular value is smaller
  // While the moment changes by a tenth of its size or less, the cofactors change by 2.1 sizes times that; while they
  // change by half of theirs or less, what is added changes by their change over the root of that half.
  const double of_cofactors = 2.1 * size, of_whole = 1 + of_cofactors / std::sqrt(0.5 * plane);
  const double change = std::min({0.1 * size, 0.5 * plane / of_cofactors, 0.5 * least / of_whole});
  return {2 / 1.5 * of_whole / least * arms, change / arms};
}

RigidMotion rigid_motion(const Model& model, std::span<const std::int32_t> spheres, const Vec3Array& position) {
  RigidMotion motion;
  double mass = 0;
  for (const std::int32_t sphere : spheres) {
    const auto i = std::size_t(sphere);
    mass += model.mass[i];
    motion.from += model.mass[i] * model.rest_position[i], motion.to += model.mass[i] * position[i];
  }
  motion.from = motion.from / mass, motion.to = motion.to / mass;
  Matrix moment{};
  for (const std::int32_t sphere : spheres) {
    const auto i = std::size_t(sphere);
    add_moment(moment, model.mass[i] * (position[i] - motion.to), model.rest_position[i] - motion.from);
  }
  motion.turn.entry = nearest_rotation(moment);
  return motion;
}

}  // namespace ctpm::surface
