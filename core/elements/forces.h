#pragma once

#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::elements {

/// Force of all elements on every sphere [N] at this very moment: springs, dashpots, two-sphere TPMs at their
/// present Kelvin elongation, constraints, softening (Eqs. 1-8). No gravity, no tool  (sphere_count).
Vec3Array internal_forces(const Model& model, const State& state);

/// Energy stored in axial elements and in angle springs [J]: of springs and Kelvin units 0.5 k x^2, of two-sphere TPMs
/// that of both their springs. Softening (Eq. 8) has no energy of its own and is not counted; constraints are not
/// either.
double elastic_energy(const Model& model, const State& state);

}  // namespace ctpm::elements
