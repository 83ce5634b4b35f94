#include "core/stepping/integrator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace ctpm::stepping {
namespace {

/// Largest number of explicit substeps that cost less than one step of sdirk2.
constexpr std::int32_t kMostExplicitSubsteps = 2;

/// What needs more explicit substeps than this is too stiff for the predictor of sdirk2.
constexpr std::int32_t kMostPredictedSubsteps = 4;

/// Tissue whose own viscosity damps swinging slower than this [1/s] does not suffice (our choice: liver has 1.5, kidney
/// 7; three of some two hundred meshes filled with tissue of 1.5 gained energy after a cut, until the simulation
/// ended).
constexpr double kLeastLoss = 5;

/// The choice keeps to this share of the proven step.
constexpr double kSafety = 0.9;

/// Bounds on the stiffness and the damping of each sphere, divided by its mass.
struct Bound {
  std::vector<double> stiffness, damping;  ///< [1/s^2], [1/s]  (sphere_count)
};

Bound bound_of(const Model& model) {
  Bound bound{std::vector<double>(model.sphere_count()), std::vector<double>(model.sphere_count())};
  const auto add = [&](std::int32_t sphere, double k, double c) {
    const auto i = std::size_t(sphere);
    bound.stiffness[i] += k / model.mass[i], bound.damping[i] += c / model.mass[i];
  };
  const AxialElements& axial = model.axial;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    // The Kelvin elongation of a two-sphere TPM follows implicitly, so the spheres feel only its spring.
    const double c = axial.law[i] == AxialLaw::two_sphere_tpm ? 0.0 : axial.damping(i);
    for (const std::int32_t end : {axial.a[i], axial.b[i]}) add(end, 2 * axial.k[i], 2 * c);
  }
  const Constraints& lines = model.constraints;
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (const std::int32_t sphere : {lines.a[i], lines.c[i], lines.e[i]}) add(sphere, 3 * lines.k[i], 0);
  const AngleSprings& angles = model.angle_springs;
  for (std::size_t i = 0; i < angles.size(); ++i)
    for (const std::int32_t sphere : {angles.a[i], angles.b[i], angles.c[i]}) add(sphere, 1.5 * angles.k[i], 0);
  return bound;
}

std::string with_milliseconds(const char* format, double seconds) {
  char text[256];
  std::snprintf(text, sizeof text, format, seconds * 1e3);
  return text;
}

/// Whether elements are not as long at rest as they would like to be: once the tissue settles, light spheres swing.
bool is_prestrained(const Model& model) {
  constexpr double kLeast = 1e-3;  // of a length
  const AxialElements& axial = model.axial;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    const Vec3 along =
        Vec3(model.rest_position[std::size_t(axial.b[i])]) - model.rest_position[std::size_t(axial.a[i])];
    if (std::abs(norm(along) - axial.rest_length[i]) > kLeast * axial.rest_length[i]) return true;
  }
  return false;
}

}  // namespace

double stable_step_bound(const Model& model) {
  const Bound bound = bound_of(model);
  double longest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < model.sphere_count(); ++i) {
    if (model.held_axes[i] == kAnchored) continue;
    const double k = bound.stiffness[i], c = bound.damping[i];
    // The positive root of h^2 k + 2 h c = 4, written without cancellation.
    const double root = c + std::sqrt(c * c + 4 * k);
    if (root > 0) longest = std::min(longest, 4 / root);
  }
  return longest;
}

double stiffness_ratio_bound(const Model& model, double h) {
  const Bound bound = bound_of(model);
  double ratio = 0;
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (model.held_axes[i] != kAnchored) ratio = std::max(ratio, h * (h * bound.stiffness[i] + bound.damping[i]));
  return ratio;
}

double loss_rate(const Model& model) {
  double least = std::numeric_limits<double>::infinity();
  const AxialElements& axial = model.axial;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    if (!(axial.damping(i) > 0)) return 0;
    if (axial.law[i] == AxialLaw::two_sphere_tpm) least = std::min(least, axial.k[i] / (2 * axial.damping(i)));
  }
  return least;
}

IntegratorChoice choose_integrator(const Model& model) {
  const double longest = stable_step_bound(model);
  const std::int32_t asked = model.solver.substeps;
  const double needed = std::max(std::ceil(model.tick / (kSafety * longest)), double(asked));
  const bool swings = model.has_scalpel() || is_prestrained(model);
  const std::string what = model.has_scalpel() ? "a cut leaves" : "tension at rest sets";
  if (swings && model.has_softening && loss_rate(model) < kLeastLoss)
    return {Integrator::backward_euler, asked, true, true,
            "softening gives energy to what " + what + " swinging, and the tissue's own viscosity hardly damps it"};
  if (!swings && needed <= std::max(kMostExplicitSubsteps, asked))
    return {Integrator::leapfrog, std::int32_t(needed), true, true,
            with_milliseconds("nothing in the scene is too stiff for an explicit step of up to %.3g ms", longest)};
  if (needed <= std::max(kMostPredictedSubsteps, asked))
    return {Integrator::sdirk2, asked, true, true,
            swings ? what + " light tissue swinging faster than a tick, which an explicit step never damps"
                   : with_milliseconds("an implicit step costs less than explicit ones of up to %.3g ms", longest)};
  return {Integrator::backward_euler, asked, true, true,
          with_milliseconds("the scene is stiff: an explicit step would have to be shorter than %.3g ms", longest)};
}

IntegratorChoice check_integrator(const Model& model) {
  const SolverSettings& solver = model.solver;
  IntegratorChoice choice{solver.integrator, solver.substeps, true, true, "the Model names it"};
  if (solver.integrator == Integrator::sdirk2) {
    choice.damps = false;
    choice.reason =
        "the Model names it, but it has no numerical damping: motion that no dashpot damps goes on, and gains the work "
        "that Eq. 8 does in closed cycles";
  }
  if (solver.integrator != Integrator::leapfrog) return choice;
  const double longest = stable_step_bound(model);
  if (model.tick / solver.substeps > longest) {
    choice.holds = false;
    choice.reason = with_milliseconds("it is asked for, but it only holds for substeps up to %.3g ms", longest);
  }
  return choice;
}

IntegratorChoice resolve_integrator(Model& model, std::optional<Integrator> asked) {
  if (asked) {
    model.solver.integrator = *asked;
    return check_integrator(model);
  }
  const IntegratorChoice choice = choose_integrator(model);
  model.solver.integrator = choice.integrator, model.solver.substeps = choice.substeps;
  return choice;
}

const char* name_of(Integrator integrator) {
  switch (integrator) {
    case Integrator::leapfrog:
      return "leapfrog";
    case Integrator::backward_euler:
      return "backward-euler";
    case Integrator::sdirk2:
      return "sdirk2";
  }
  return "unknown";
}

const char* name_of(std::optional<Integrator> asked) { return asked ? name_of(*asked) : "auto"; }

}  // namespace ctpm::stepping
