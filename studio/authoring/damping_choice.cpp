#include "studio/authoring/damping_choice.h"

#include "core/stepping/integrator.h"

namespace ctpm::authoring {
namespace {

/// Tissue whose own viscosity damps swinging slower than this [1/s] does not suffice (our choice: liver has 1.5, kidney
/// 7; three of some two hundred meshes filled with tissue of 1.5 gained energy after a cut, until the simulation
/// ended).
constexpr double kLeastLoss = 5;

}  // namespace

bool needs_damping(const Model& model) {
  return model.has_softening && model.solver.integrator == Integrator::leapfrog &&
         stepping::loss_rate(model) < kLeastLoss;
}

}  // namespace ctpm::authoring
