#pragma once

#include "core/model/vec3.h"

namespace ctpm::render {

/// Smooth noise in [-1, 1] with features of size 1 and period 64. Equal on every machine and in every run.
double noise_at(Vec3 place);

}  // namespace ctpm::render
