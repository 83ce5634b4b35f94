#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "core/model/state.h"
#include "studio/loading/loaded_scene.h"

// The models that an experiment compares, made alike in everything but what is compared: one integrator, one static
// stiffness, one state of rest to start from.
namespace ctpm::paper {

/// Integrator of every run that compares models in motion. It is of second order and adds next to no numerical damping
/// to motion that it resolves, and it holds with stiff dashpots, which leapfrog does not.
constexpr scenes::IntegratorSpec kIntegrator = scenes::IntegratorSpec::sdirk2;
/// Its name in text.
const char* integrator_name();

/// Factor on the moduli and the viscosity of a network of two-sphere TPMs with which it is statically as stiff as the
/// others. A triple is one spring and one Kelvin unit over two spacings, P2 = K1 K2 / (K1 + K2). Two two-sphere TPMs,
/// each of them P2, cover the same two spacings one behind the other and give P2 / 2.
constexpr double kTpmStiffness = 2;

/// One of the models that an experiment compares.
struct Variant {
  const char* name;
  network::Structure structure;
  bool is_pa_s;               ///< viscosity as printed, in Pa s/mm
  const char* reading;        ///< unit of the viscosity, for the page; empty: the model has none
  double stiffness = 1;       ///< factor on all moduli and the viscosity
  bool has_dashpots = false;  ///< mass-spring with a dashpot beside every spring
};
/// "CTPM, kPa s".
std::string full_name(const Variant& variant);
/// Gives the scene's first organ the variant's structure, viscosity and stiffness.
void use_variant(scenes::SceneSpec& scene, const Variant& variant);

/// Builds the scene as the variant, with kIntegrator unless `change` names another one. Every spring of a mass-spring
/// network has the stiffness 2 P2; with dashpots it gets v1 beside it, as the Kelvin units of a triple have. Errors:
/// those of build_model().
Result<scenes::BuiltScene> build_variant(const loading::LoadedScene& scene, const Variant& variant,
                                         const std::function<void(scenes::SceneSpec&)>& change);

/// The Model at rest under gravity, without loads and tools, found with backward Euler whatever the Model's integrator:
/// undamped motion of the beginning would otherwise be taken for an effect of the experiment. Error: does not come to
/// rest.
Result<State> settled(const Model& model, const std::string& name);

/// A measure of the Model at rest under gravity and its loads. Newton's method, up to a change of 1e-6. Error: does not
/// come to rest.
Result<double> at_rest(Model model, const std::string& name, const std::function<double(const State&)>& measure);

}  // namespace ctpm::paper
