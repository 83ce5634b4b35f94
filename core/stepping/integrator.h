#pragma once

#include <string>

#include "core/model/model.h"

namespace ctpm {

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
  Integrator integrator = Integrator::backward_euler;  ///< never `automatic`
  std::int32_t substeps = 1;                           ///< of one tick, >= 1
  bool holds = true;   ///< false: named by the scene, but its substep is longer than what it is proven to hold
  bool damps = true;   ///< false: says beforehand that motion may go on, or gain energy, where no dashpot damps it
  std::string reason;  ///< one sentence
};

/// Follows SolverSettings::integrator; `automatic` is decided from the Model alone: leapfrog where few substeps hold
/// it, backward Euler where not.
IntegratorChoice choose_integrator(const Model& model);

/// Name of an integrator in scenes and reports.
const char* name_of(Integrator integrator);

}  // namespace ctpm
