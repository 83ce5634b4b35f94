#pragma once

#include <optional>
#include <string>

#include "core/model/model.h"

namespace ctpm::stepping {

/// Longest step [s] for which leapfrog is proven to hold, or infinity if nothing is stiff.
///
/// A linear system M x'' + C x' + K x = 0 stays bounded while h^2 k + 2 h c < 4 for the largest k of M^-1 K and c of
/// M^-1 C together. Each element's share in both is bounded by what it does to its own spheres, whatever the shape the
/// tissue is in: 2 k / m for a spring, 1.5 * 2 k' / m for a constraint; the sum over one sphere's elements bounds the
/// whole (Gershgorin). Contacts do not count, they are solved implicitly.
double stable_step_bound(const Model& model);

/// Bounds the largest eigenvalue of M^-1 (h^2 K + h C) for a step of `h` [s] in the same way [1].
double stiffness_ratio_bound(const Model& model, double h);

/// How a Model is integrated, and why.
struct IntegratorChoice {
  Integrator integrator = Integrator::backward_euler;
  std::int32_t substeps = 1;  ///< of one tick, >= 1
  bool holds = true;          ///< false: the substep is longer than what the integrator is proven to hold
  bool damps = true;          ///< false: the method adds no numerical damping; what no dashpot damps may go on or gain
                              ///< energy
  std::string reason;         ///< one sentence
};

/// Chooses by the Model alone, whatever integrator it names: leapfrog where few substeps hold it, backward Euler where
/// not. Takes at least SolverSettings::substeps.
IntegratorChoice choose_integrator(const Model& model);

/// Whether the integrator and the substeps that the Model names hold its stiffness.
IntegratorChoice check_integrator(const Model& model);

/// Sets the Model's integrator and substeps: `asked` if it is given, which is then checked, or those that
/// choose_integrator() gives. Call it last: its choice depends on the network, the masses, the tick and the substeps.
IntegratorChoice resolve_integrator(Model& model, std::optional<Integrator> asked = std::nullopt);

/// Name of an integrator in scenes and reports; "auto" if none is asked for.
const char* name_of(Integrator integrator);
const char* name_of(std::optional<Integrator> asked);

}  // namespace ctpm::stepping
