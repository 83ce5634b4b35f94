#pragma once

#include <cstdint>
#include <vector>

#include "core/model/organ.h"

namespace ctpm::render {

/// As far as nearness_to_lips() tells distances, in reaches: beyond the triangles in which the edge is near, so that it
/// falls evenly over them.
inline constexpr double kLipsKnown = 3;

/// How near vertices are to the edge of a cut, whatever the size of the triangles there: 1 on it, 0 where it is `reach`
/// [m] away, and less beyond, down to 1 - kLipsKnown. `is_lip`: as in CutSurface; vertices of walls, and all where
/// nothing is cut, have 0                                                                             (vertex_count)
std::vector<float> nearness_to_lips(const Surface& surface, const std::vector<std::uint8_t>& is_lip, double reach);

}  // namespace ctpm::render
