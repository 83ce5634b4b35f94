#pragma once

#include <vector>

#include "core/model/model.h"
#include "core/model/vec3.h"

namespace ctpm::contact {

/// Puts the vertices of `surface` that a ball touches onto the ball: along their normals, inwards to its far side, as
/// BallContact measures the dent. A ball that is in deep would stand in a shaft as ragged as the mesh is coarse: the
/// tissue around it comes down to it in a funnel with sides of 45 degrees, which leaves the ball where that is as steep
/// (our choice). Nothing is moved farther than the deepest dent.
/// `centre`, `radius` of the ball [m]; `is_touched` of each vertex (vertex_count); `vertex` [m] (vertex_count).
void draw_dent(const Surface& surface, Vec3 centre, double radius, const std::vector<char>& is_touched,
               std::vector<Vec3>& vertex);

}  // namespace ctpm::contact
