#pragma once

#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::elements {

/// Present force of all elements on every sphere [N]: springs, dashpots, two-sphere TPMs at their present Kelvin
/// elongation, constraints and softening (Eqs. 1-8). Without gravity and tools (sphere_count).
Vec3Array internal_forces(const Model& model, const State& state);

/// Energy stored in axial elements and angle springs [J]: 0.5 k x^2 of springs and Kelvin units, the sum over both
/// springs of two-sphere TPMs. Constraints are not counted, and softening (Eq. 8) has no energy.
double elastic_energy(const Model& model, const State& state);

/// Energy that dashpots and Kelvin units dissipate in the tick from `before` to `after` [J], without elements that are
/// severed in it.
double viscous_work(const Model& model, const State& before, const State& after);

/// Elastic energy [J] that is gone with the elements and angle springs that are severed in `after` and not in `before`,
/// where they are at the end.
double severed_energy(const Model& model, const State& before, const State& after);

}  // namespace ctpm::elements
