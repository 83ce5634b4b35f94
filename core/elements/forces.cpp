#include "core/elements/forces.h"

#include "core/elements/elements.h"

namespace ctpm::elements {

Vec3Array internal_forces(const Model& model, const State& state) {
  const std::size_t n = model.sphere_count();
  Coordinates sum(3 * n, 0.0);
  parallel::Team alone(1);
  Elements(model, alone).add_forces(state, sum);
  Vec3Array force(n);
  for (std::size_t i = 0; i < n; ++i) force.set(i, {sum[i], sum[n + i], sum[2 * n + i]});
  return force;
}

double elastic_energy(const Model& model, const State& state) {
  const auto at = [&](std::int32_t sphere) { return state.position[std::size_t(sphere)]; };
  const auto lives = [](const std::vector<std::uint8_t>& severed, std::size_t i) {
    return severed.empty() || severed[i] == 0;
  };
  double energy = 0;
  const AxialElements& axial = model.axial;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    if (!lives(state.axial_severed, i)) continue;
    double x = norm(at(axial.b[i]) - at(axial.a[i])) - axial.rest_length[i];
    if (axial.law[i] == AxialLaw::two_sphere_tpm) {
      const double z = state.kelvin_elongation[std::size_t(axial.internal[i])];
      x -= z, energy += 0.5 * axial.kelvin_k[i] * z * z;
    }
    energy += 0.5 * axial.k[i] * x * x;
  }
  const AngleSprings& springs = model.angle_springs;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const Vec3 u = at(springs.b[i]) - 0.5 * (at(springs.a[i]) + at(springs.c[i]));
    if (lives(state.angle_severed, i)) energy += 0.5 * springs.k[i] * dot(u, u);
  }
  return energy;
}

double viscous_work(const Model& model, const State& before, const State& after) {
  double work = 0;
  const AxialElements& axial = model.axial;
  for (std::size_t e = 0; e < axial.size(); ++e) {
    if (after.axial_severed[e]) continue;
    const auto a = std::size_t(axial.a[e]), b = std::size_t(axial.b[e]);
    const Vec3 d = before.position[b] - before.position[a];
    double rate = dot(after.velocity[b] - after.velocity[a], d) / norm(d);
    if (axial.law[e] == AxialLaw::two_sphere_tpm) {
      const auto t = std::size_t(axial.internal[e]);
      rate = (after.kelvin_elongation[t] - before.kelvin_elongation[t]) / model.tick;
    }
    work += model.tick * axial.damping(e) * rate * rate;
  }
  return work;
}

double severed_energy(const Model& model, const State& before, const State& after) {
  if (before.axial_severed == after.axial_severed) return 0;
  State whole = after;
  whole.axial_severed = before.axial_severed, whole.angle_severed = before.angle_severed;
  return elastic_energy(model, whole) - elastic_energy(model, after);
}

}  // namespace ctpm::elements
