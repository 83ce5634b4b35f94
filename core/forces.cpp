#include "core/forces.h"

#include "core/elements.h"

namespace ctpm {

Vec3Array internal_forces(const Model& model, const State& state) {
  const std::size_t n = model.sphere_count();
  Coordinates sum(3 * n, 0.0);
  Elements(model).add_forces(state, sum);
  Vec3Array force(n);
  for (std::size_t i = 0; i < n; ++i) force.set(i, {sum[i], sum[n + i], sum[2 * n + i]});
  return force;
}

double elastic_energy(const Model& model, const State& state) {
  return AxialElements(model).elastic_energy(state) + AngleElements(model).elastic_energy(state);
}

}  // namespace ctpm
