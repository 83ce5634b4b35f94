#pragma once

#include <optional>
#include <string>

#include "core/model/model.h"

namespace ctpm::stepping {

/// Longest step [s] for which leapfrog is proven stable; infinity if nothing is stiff.
///
/// A linear system M x'' + C x' + K x = 0 stays bounded while h^2 k + 2 h c < 4, with k and c the largest eigenvalues
/// of M^-1 K and M^-1 C. Whatever the deformation, a spring adds at most 2 k / m to a sphere of mass m, and a
/// constraint at most 1.5 * 2 k' / m. The largest sum over the elements of one sphere bounds the eigenvalues
/// (Gershgorin). Contacts do not count: they are solved implicitly.
double stable_step_bound(const Model& model);

/// Bound on the largest eigenvalue of M^-1 (h^2 K + h C) for a step of `h` [s], found in the same way [1].
double stiffness_ratio_bound(const Model& model, double h);

/// Rate at which the tissue's own viscosity damps fast motion at least [1/s]: k2 / 2 c of a two-sphere TPM, whose loss
/// tangent tends to k2 / (omega c); 0 where axial elements lack dashpots.
double loss_rate(const Model& model);

/// How a Model is integrated, and why.
struct IntegratorChoice {
  Integrator integrator = Integrator::backward_euler;
  std::int32_t substeps = 1;  ///< of one tick, >= 1
  bool holds = true;          ///< false: the substep is longer than the proven bound of the integrator
  /// False: the method adds no numerical damping, and motion that no dashpot damps may go on or gain energy. Only
  /// sdirk2 sets it, although leapfrog adds none either.
  bool damps = true;
  std::string reason;  ///< one sentence
};

/// Chooses by the Model alone, whatever integrator it names. Leapfrog where it is stable with so few substeps that they
/// cost less than an implicit step, no blade can cut, and nothing is under tension at rest: the spheres at an organ's
/// boundary have next to no mass, and once a cut or that tension sets them swinging, they do so faster than a tick.
/// Else sdirk2, which is L-stable and of second order; backward Euler where the scene is too stiff for its predictor,
/// or where softening (Eq. 8) gives energy to what swings so and which its own viscosity hardly damps. Uses at least
/// SolverSettings::substeps.
IntegratorChoice choose_integrator(const Model& model);

/// Checks whether the integrator and the substeps of the Model are stable for its stiffness.
IntegratorChoice check_integrator(const Model& model);

/// Sets the Model's integrator and substeps. `asked`, if given, is set and checked; otherwise choose_integrator()
/// decides. Call it last: the choice depends on the network, the masses, the tick and the substeps.
IntegratorChoice resolve_integrator(Model& model, std::optional<Integrator> asked = std::nullopt);

/// Name of an integrator in scenes and reports; "auto" if none is asked for.
const char* name_of(Integrator integrator);
const char* name_of(std::optional<Integrator> asked);

}  // namespace ctpm::stepping
