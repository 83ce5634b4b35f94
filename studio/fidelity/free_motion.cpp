// Bodies that nothing holds: a spin keeps its angular momentum, a fall its shape.

#include <algorithm>
#include <cmath>

#include "core/stepping/integrator.h"
#include "studio/fidelity/recipes.h"

namespace ctpm::fidelity {
namespace {

constexpr double kSpin = 10, kSpinTime = 1.0, kFallTime = 0.3, kGravity = 9.81;

/// Angular momentum about the centre of mass along z [kg m^2/s], and kinetic energy [J].
std::pair<double, double> spin_of(const Model& model, const State& state) {
  const Vec3 centre = centre_of_mass(model, state.position);
  double momentum = 0, energy = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    const Vec3 v = state.velocity[i];
    momentum += model.mass[i] * cross(state.position[i] - centre, v).z;
    energy += 0.5 * model.mass[i] * dot(v, v);
  }
  return {momentum, energy};
}

}  // namespace

Result<FreeMotionResult> measure_free_motion(double radius) {
  Specimen specimen = ball_organ(radius, Pace::live);
  const Result<Body> spinning = make_body(specimen);
  if (!spinning) return spinning.errors();
  FreeMotionResult result;
  result.radius = radius;
  result.integrator = stepping::name_of(spinning->model.solver.integrator);
  State state = rest_state(spinning->model);
  const Vec3 centre = centre_of_mass(spinning->model, state.position);
  for (std::size_t i = 0; i < spinning->model.sphere_count(); ++i)
    state.velocity.set(i, cross({0, 0, kSpin}, state.position[i] - centre));
  const auto [momentum, energy] = spin_of(spinning->model, state);
  run_for(spinning->model, state, kSpinTime);
  const auto [momentum_after, energy_after] = spin_of(spinning->model, state);
  result.angular_momentum = momentum_after / momentum, result.energy = energy_after / energy;

  specimen.gravity = {0, 0, -kGravity};
  const Result<Body> falling = make_body(specimen);
  if (!falling) return falling.errors();
  State fallen = rest_state(falling->model);
  const Vec3 from = centre_of_mass(falling->model, fallen.position);
  run_for(falling->model, fallen, kFallTime);
  const Vec3 way = centre_of_mass(falling->model, fallen.position) - from;
  result.fall = -way.z / (0.5 * kGravity * kFallTime * kFallTime);
  for (std::size_t i = 0; i < falling->model.sphere_count(); ++i)
    result.shape = std::max(result.shape, norm(fallen.position[i] - falling->model.rest_position[i] - way));
  return result;
}

Chapter chapter_of(const FreeMotionResult& result) {
  Chapter chapter;
  reports::Section& section = chapter.section;
  section.key = "free-motion", section.title = "Free spin and free fall";
  section.paragraphs = {
      "A ball organ of 40 mm radius that nothing holds, with ticks of 1 ms and the integrator that `auto` takes (" +
      result.integrator + "): it spins at 10 rad/s for 1 s, and falls for 0.3 s."};
  reports::Table table;
  table.columns = {{"figure", "figure"}, {"value", "value", 6}};
  table.rows = {{std::string("angular momentum after over before"), result.angular_momentum},
                {std::string("kinetic energy after over before"), result.energy},
                {std::string("fall over g t^2 / 2"), result.fall},
                {std::string("largest deviation from a rigid fall [mm]"), 1e3 * result.shape}};
  section.tables = {table};
  chapter.figures = {{.recipe = "free-motion",
                      .name = "angular momentum kept in 1 s",
                      .radius = result.radius,
                      .measured = result.angular_momentum,
                      .reference = 1.0,
                      .source = "conservation",
                      .goal = Goal{0.99, 1.01}},
                     {.recipe = "free-motion",
                      .name = "fall over g t^2 / 2",
                      .radius = result.radius,
                      .measured = result.fall,
                      .reference = 1.0,
                      .source = "closed form",
                      .goal = Goal{0.99, 1.01}},
                     {.recipe = "free-motion",
                      .name = "change of shape in the fall",
                      .radius = result.radius,
                      .measured = 1e3 * result.shape,
                      .unit = "mm",
                      .reference = 0.0,
                      .source = "closed form",
                      .goal = Goal{{}, 0.01}}};
  return chapter;
}

}  // namespace ctpm::fidelity
