#pragma once

#include "core/model/vec3.h"

namespace ctpm::render {

/// Smooth noise in [-1, 1] with features of the size of 1; the same everywhere and always, repeats after 64.
double noise_at(Vec3 place);

}  // namespace ctpm::render
