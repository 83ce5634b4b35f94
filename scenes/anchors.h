#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/organ.h"
#include "core/model/result.h"
#include "scenes/scene_spec.h"

namespace ctpm::scenes {

/// How high the organ's lowest point lies against gravity, along z where there is none [m].
double lowest_height(const FilledOrgan& organ, Vec3 gravity);

/// Spheres of the organ that any of its anchors holds, by index within the organ, ascending. `counts` receives the
/// number of spheres of each anchor. Errors: an anchor that holds no sphere, at `where`/anchors/I, with the organ's
/// extent.
Result<std::vector<std::int32_t>> select_anchored(const FilledOrgan& organ, const std::vector<AnchorSpec>& anchors,
                                                  Vec3 gravity, const std::string& where,
                                                  std::vector<std::int32_t>* counts = nullptr);

/// Reads an anchor as a command line gives it, in mm: `lowest:HEIGHT`, `box:X0,Y0,Z0,X1,Y1,Z1`,
/// `sphere:X,Y,Z,R`, `plane:X,Y,Z,NX,NY,NZ` (a point and the normal towards the free side). Error: the text,
/// and how it is written.
Result<AnchorSpec> parse_anchor(const std::string& text);

}  // namespace ctpm::scenes
