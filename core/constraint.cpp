#include "core/constraint.h"

#include <algorithm>
#include <cmath>

namespace ctpm {
namespace {

/// Couplings below this part of the sphere's mass change the matrix by less than any solver tolerance.
constexpr double kNegligibleCoupling = 1e-6;

}  // namespace

ConstraintElements::ConstraintElements(const Model& model)
    : model_(model), offset_(model.constraints.size()), half_length_(model.constraints.size()) {
  active_.reserve(model.constraints.size());
  isotropic_.reserve(model.constraints.size());
  along_.reserve(model.constraints.size());
}

void ConstraintElements::measure_tilt(const State& state, std::vector<double>& softness) {
  std::fill(softness.begin(), softness.end(), 1.0);
  const Constraints& lines = model_.constraints;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!state.constraint_severed.empty() && state.constraint_severed[i]) {
      offset_[i] = {}, half_length_[i] = 0;
      continue;
    }
    const Vec3 a = state.position[std::size_t(lines.a[i])], e = state.position[std::size_t(lines.e[i])];
    const auto centre = std::size_t(lines.c[i]);
    offset_[i] = state.position[centre] - 0.5 * (a + e);
    half_length_[i] = 0.5 * norm(e - a);
    // 1 / (1 + tan theta) written so that it stays finite when A and E meet.
    const double tilt = norm(offset_[i]), sum = half_length_[i] + tilt;
    if (!softness.empty() && sum > 0) softness[centre] = std::min(softness[centre], half_length_[i] / sum);
  }
}

void ConstraintElements::add_forces(const State& state, std::span<const double> softness,
                                    Coordinates& force) const {
  const Constraints& lines = model_.constraints;
  const std::size_t spheres = state.position.size();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Vec3 u = offset_[i];
    const double tilt = norm(u), hypotenuse = std::sqrt(tilt * tilt + half_length_[i] * half_length_[i]);
    if (tilt == 0) continue;
    const auto c = std::size_t(lines.c[i]);
    const double soft = softness.empty() ? 1.0 : softness[c];
    // Eq. 2 with Eq. 8: lambda = 2 k' (1 - cos theta), force on C is -lambda u / (1 + tan theta).
    const Vec3 pull = -2 * lines.k[i] * (1 - half_length_[i] / hypotenuse) * soft * u;
    force[c] += pull.x, force[spheres + c] += pull.y, force[2 * spheres + c] += pull.z;
    for (const auto end : {std::size_t(lines.a[i]), std::size_t(lines.e[i])})
      force[end] -= 0.5 * pull.x, force[spheres + end] -= 0.5 * pull.y,
          force[2 * spheres + end] -= 0.5 * pull.z;
  }
}

void ConstraintElements::linearise(const State& state, std::span<const double> softness, double h,
                                   Coordinates& force, DiagonalBlocks& blocks) {
  const Constraints& lines = model_.constraints;
  const std::size_t spheres = state.position.size();
  add_forces(state, softness, force);
  active_.clear(), isotropic_.clear(), along_.clear();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Vec3 u = offset_[i];
    const double tilt = norm(u), hypotenuse = std::sqrt(tilt * tilt + half_length_[i] * half_length_[i]);
    if (tilt == 0) continue;
    const auto a = std::size_t(lines.a[i]), c = std::size_t(lines.c[i]), e = std::size_t(lines.e[i]);
    const double cosine = half_length_[i] / hypotenuse, sine = tilt / hypotenuse;
    const double soft = softness.empty() ? 1.0 : softness[c];
    const double lambda = 2 * lines.k[i] * (1 - cosine) * soft;
    // d(lambda u)/du = lambda I + 2 k' cos sin^2 along u; the softening is held, which keeps it positive
    // definite.
    const double isotropic = h * h * lambda, along = h * h * 2 * lines.k[i] * cosine * sine * sine * soft;
    if (isotropic + along < kNegligibleCoupling * model_.mass[c]) continue;
    active_.push_back(std::int32_t(i)), isotropic_.push_back(isotropic);
    along_.push_back(std::sqrt(along) / tilt * u);
    const Vec3 m = along_.back();
    const auto add_block = [&](std::size_t sphere, double weight) {
      double* block = &blocks[sphere];
      block[0] += weight * (m.x * m.x + isotropic), block[spheres] += weight * m.x * m.y;
      block[2 * spheres] += weight * m.x * m.z, block[3 * spheres] += weight * (m.y * m.y + isotropic);
      block[4 * spheres] += weight * m.y * m.z, block[5 * spheres] += weight * (m.z * m.z + isotropic);
    };
    add_block(c, 1.0), add_block(a, 0.25), add_block(e, 0.25);
  }
}

void ConstraintElements::apply(const Coordinates& v, Coordinates& result) const {
  const Constraints& lines = model_.constraints;
  const std::size_t spheres = v.size() / 3;
  const auto get = [&](std::size_t i) { return Vec3{v[i], v[spheres + i], v[2 * spheres + i]}; };
  const auto add = [&](std::size_t i, Vec3 q) {
    result[i] += q.x, result[spheres + i] += q.y, result[2 * spheres + i] += q.z;
  };
  for (std::size_t n = 0; n < active_.size(); ++n) {
    const auto i = std::size_t(active_[n]);
    const auto a = std::size_t(lines.a[i]), c = std::size_t(lines.c[i]), e = std::size_t(lines.e[i]);
    const Vec3 relative = get(c) - 0.5 * (get(a) + get(e));
    const Vec3 q = dot(along_[n], relative) * along_[n] + isotropic_[n] * relative;
    add(c, q), add(a, -0.5 * q), add(e, -0.5 * q);
  }
}

}  // namespace ctpm
