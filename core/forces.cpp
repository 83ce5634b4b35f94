#include "core/forces.h"

#include "core/angle_spring.h"
#include "core/axial.h"
#include "core/constraint.h"

namespace ctpm {

Vec3Array internal_forces(const Model& model, const State& state) {
  // In a vanishing step the Kelvin units do not creep, which leaves the force of this moment.
  constexpr double kVanishingStep = 1e-12;
  const std::size_t n = model.sphere_count();
  AxialElements axial(model);
  ConstraintElements constraints(model);
  Coordinates sum(3 * n, 0.0), velocity;
  DiagonalBlocks blocks(6 * n, 0.0);
  std::vector<double> softness(model.has_softening ? n : 0);
  constraints.measure_tilt(state, softness);
  constraints.linearise(state, softness, kVanishingStep, sum, blocks);
  AngleElements(model).linearise(state, kVanishingStep, sum, blocks);
  axial.linearise(state, softness, kVanishingStep, sum, blocks);
  for (const auto* coordinate : {&state.velocity.x, &state.velocity.y, &state.velocity.z})
    velocity.insert(velocity.end(), coordinate->begin(), coordinate->end());
  axial.add_damping_forces(state, softness, velocity, sum);
  Vec3Array force(n);
  for (std::size_t i = 0; i < n; ++i) force.set(i, {sum[i], sum[n + i], sum[2 * n + i]});
  return force;
}

double elastic_energy(const Model& model, const State& state) {
  return AxialElements(model).elastic_energy(state) + AngleElements(model).elastic_energy(state);
}

}  // namespace ctpm
