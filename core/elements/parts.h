#pragma once

#include <vector>

#include "core/model/model.h"
#include "core/parallel/slabs.h"

namespace ctpm::elements {

/// The parts of a Model between which no element acts: organs, or organs that elements join. They partition the
/// spheres, in ascending order. A Model without organs is one part, and so is one without spheres.
std::vector<parallel::SphereRange> parts_of(const Model& model);

}  // namespace ctpm::elements
