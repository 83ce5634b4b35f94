#include "core/angle_spring.h"

namespace ctpm {
namespace {

/// u = B - (A + C) / 2: how far the middle sphere is from the middle of its neighbours.
Vec3 bend(Vec3 a, Vec3 b, Vec3 c) { return b - 0.5 * (a + c); }

Vec3 get(const Coordinates& v, std::size_t i) {
  const std::size_t n = v.size() / 3;
  return {v[i], v[n + i], v[2 * n + i]};
}

void add(Coordinates& v, std::size_t i, Vec3 q) {
  const std::size_t n = v.size() / 3;
  v[i] += q.x, v[n + i] += q.y, v[2 * n + i] += q.z;
}

}  // namespace

void AngleElements::add_forces(const State& state, Coordinates& force) const {
  const AngleSprings& springs = model_.angle_springs;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    if (!lives(state, i)) continue;
    const auto a = std::size_t(springs.a[i]), b = std::size_t(springs.b[i]), c = std::size_t(springs.c[i]);
    const Vec3 pull = -springs.k[i] * bend(state.position[a], state.position[b], state.position[c]);
    add(force, b, pull), add(force, a, -0.5 * pull), add(force, c, -0.5 * pull);
  }
}

void AngleElements::linearise(const State& state, double h, Coordinates& force,
                              DiagonalBlocks& blocks) const {
  add_forces(state, force);
  const AngleSprings& springs = model_.angle_springs;
  const std::size_t n = state.position.size();
  for (std::size_t i = 0; i < springs.size(); ++i) {
    if (!lives(state, i)) continue;
    const auto a = std::size_t(springs.a[i]), b = std::size_t(springs.b[i]), c = std::size_t(springs.c[i]);
    const double coupling = h * h * springs.k[i];
    for (const std::size_t diagonal : {std::size_t(0), 3 * n, 5 * n}) {
      blocks[diagonal + b] += coupling;
      blocks[diagonal + a] += 0.25 * coupling, blocks[diagonal + c] += 0.25 * coupling;
    }
  }
}

void AngleElements::apply(const State& state, double h, const Coordinates& v, Coordinates& result) const {
  const AngleSprings& springs = model_.angle_springs;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    if (!lives(state, i)) continue;
    const auto a = std::size_t(springs.a[i]), b = std::size_t(springs.b[i]), c = std::size_t(springs.c[i]);
    const Vec3 q = h * h * springs.k[i] * bend(get(v, a), get(v, b), get(v, c));
    add(result, b, q), add(result, a, -0.5 * q), add(result, c, -0.5 * q);
  }
}

double AngleElements::elastic_energy(const State& state) const {
  const AngleSprings& springs = model_.angle_springs;
  double energy = 0;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    if (!lives(state, i)) continue;
    const Vec3 u = bend(state.position[std::size_t(springs.a[i])], state.position[std::size_t(springs.b[i])],
                        state.position[std::size_t(springs.c[i])]);
    energy += 0.5 * springs.k[i] * dot(u, u);
  }
  return energy;
}

}  // namespace ctpm
