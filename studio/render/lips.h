#pragma once

#include <cstdint>
#include <vector>

#include "core/model/organ.h"

namespace ctpm::render {

/// How near vertices are to the edge of a cut, whatever the size of the triangles there: 1 on it, 0 where it is `reach`
/// [m] away or farther. `is_lip`: as in CutSurface; other vertices have 0                             (vertex_count)
std::vector<float> nearness_to_lips(const Surface& surface, const std::vector<std::uint8_t>& is_lip, double reach);

}  // namespace ctpm::render
