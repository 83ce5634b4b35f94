#include "core/elements/forces.h"

#include "core/elements/elements.h"

namespace ctpm {

Vec3Array internal_forces(const Model& model, const State& state) {
  const std::size_t n = model.sphere_count();
  Coordinates sum(3 * n, 0.0);
  Team alone(1);
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
  const Edges& edges = model.edges;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double x = norm(at(edges.b[i]) - at(edges.a[i])) - edges.rest_length[i];
    if (lives(state.edge_severed, i)) energy += 0.5 * edges.k[i] * x * x;
  }
  const AngleSprings& springs = model.angle_springs;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const Vec3 u = at(springs.b[i]) - 0.5 * (at(springs.a[i]) + at(springs.c[i]));
    if (lives(state.angle_severed, i)) energy += 0.5 * springs.k[i] * dot(u, u);
  }
  return energy;
}

}  // namespace ctpm
