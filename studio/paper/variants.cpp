#include "studio/paper/variants.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/stepping/step.h"
#include "scenes/presets.h"

namespace ctpm::paper {
namespace {

/// v1 / (2 P2) [s]: damping over stiffness of a mass-spring network's springs with dashpots.
double damping_time(const network::Material& m) {
  return m.viscosity * (m.kelvin + m.spring) / (2 * m.kelvin * m.spring);
}

void add_dashpots(Model& model, double time) {
  AxialElements& axial = model.axial;
  axial.c.resize(axial.size(), 0.0);
  for (std::size_t i = 0; i < axial.size(); ++i) {
    CTPM_CHECK(axial.law[i] == AxialLaw::spring, "only springs get dashpots");
    axial.law[i] = AxialLaw::kelvin_unit, axial.c[i] = time * axial.k[i];
  }
}

}  // namespace

const char* integrator_name() { return stepping::name_of(Integrator::sdirk2); }

std::string full_name(const Variant& variant) {
  return variant.name + (*variant.reading ? std::string(", ") + variant.reading : "");
}

void use_variant(scenes::SceneSpec& scene, const Variant& variant) {
  scenes::OrganSpec& organ = scene.organs[0];
  organ.structure = variant.structure;
  const auto change = [&](scenes::MaterialSpec& material) {
    if (variant.is_pa_s) material.preset += "-pa-s";
    material.stiffness_scale = variant.stiffness * material.stiffness_scale.value_or(1);
  };
  change(organ.material);
  for (scenes::LayerSpec& layer : organ.layers) change(layer.material);
}

Result<scenes::BuiltScene> build_variant(const loading::LoadedScene& scene, const Variant& variant,
                                         const std::function<void(scenes::SceneSpec&)>& change) {
  double time = 0;
  Result<scenes::BuiltScene> built = loading::build_changed(scene, [&](scenes::SceneSpec& s) {
    use_variant(s, variant);
    s.solver.integrator = kIntegrator;
    change(s);
    time = damping_time(scenes::resolve_material(s.organs[0].material).material);
  });
  if (built && variant.has_dashpots) add_dashpots(built->model, time);
  return built;
}

Result<State> settled(const Model& model, const std::string& name) {
  constexpr double kLongest = 60, kAtRest = 1e-5;  // [s], [m/s]
  Model damped = model;
  damped.solver.integrator = Integrator::backward_euler, damped.solver.substeps = 1;
  State state = rest_state(damped);
  const stepping::StepReport report = stepping::Stepper(damped).settle(state, std::llround(kLongest / damped.tick));
  double fastest = 0;
  for (std::size_t i = 0; i < damped.sphere_count(); ++i) fastest = std::max(fastest, norm(state.velocity[i]));
  if (stepping::is_refused(report.status) || !(fastest <= kAtRest))
    return Error{name, "does not come to rest before the experiment", ""};
  return state;
}

// Backward Euler with a tick far above every time constant is Newton's method for the static State.
Result<double> at_rest(Model model, const std::string& name, const std::function<double(const State&)>& measure) {
  constexpr double kEnough = 1e-6;    // change of the last step [share]
  constexpr double kNothing = 1e-12;  // of a Model that rests where it was built, only rounding is left
  constexpr int kMostSteps = 30;
  model.tick = 100;
  model.solver = {.tolerance = 1e-8,
                  .velocity_floor = 1e-14,
                  .max_iterations = 20000,
                  .substeps = 1,
                  .integrator = Integrator::backward_euler};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  double value = 0;
  for (int i = 0; i < kMostSteps; ++i) {
    const stepping::StepReport report = stepper.step(state, Inputs{});
    if (report.status != stepping::StepStatus::ok) break;
    const double before = value;
    value = measure(state);
    if (std::abs(value - before) <= std::max(kNothing, kEnough * std::abs(value))) return value;
  }
  return Error{name, "does not come to rest under its loads", ""};
}

}  // namespace ctpm::paper
