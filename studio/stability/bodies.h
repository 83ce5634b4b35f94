#pragma once

#include <vector>

#include "studio/stability/stability.h"

namespace ctpm::stability {

/// Cases of organs with a surface, as an author's scene has them: abuse from which tissue must recover, a spin that
/// nothing stops, bodies that meet. The recipes of `ctpm fidelity`, under every integrator.
void add_bodies(std::vector<StabilityCase>& cases, bool is_quick);

}  // namespace ctpm::stability
