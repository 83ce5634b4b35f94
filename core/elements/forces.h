#pragma once

#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm {

/// Force of all elements on every sphere [N] at this very moment: springs, dashpots, two-sphere TPMs at their
/// present Kelvin elongation, constraints, softening (Eqs. 1-8). No gravity, no tool  (sphere_count).
Vec3Array internal_forces(const Model& model, const State& state);

/// Energy stored in the springs of the edges and in the angle springs [J]. Softening (Eq. 8) has no energy of
/// its own and is not counted.
double elastic_energy(const Model& model, const State& state);

}  // namespace ctpm
