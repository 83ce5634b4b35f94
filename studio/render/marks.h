#pragma once

#include <string>
#include <vector>

#include "core/model/vec3.h"
#include "studio/render/camera.h"
#include "studio/render/frame.h"
#include "studio/render/scene_view.h"

namespace ctpm::render {

/// Something that an author placed and that has no shape of its own: drawn over the picture, whatever is in front of
/// it.
struct Mark {
  enum class Shape {
    dot,   ///< at each point
    ring,  ///< around each point
    line,  ///< from point to point
    arrow  ///< as line, with a head at the end
  } shape = Shape::dot;
  std::vector<Vec3> points;  ///< [m]
  Colour colour{1, 1, 1};
  std::string label;  ///< beside the last point; empty: none
  double size = 1;    ///< of dots, times the usual one
};

/// Draws marks as `camera` sees them. Points behind it are left out.
void draw_marks(Frame& frame, const Camera& camera, const std::vector<Mark>& marks);

/// Arrows along x, y and z from a corner of the box, each a quarter of its diagonal long at most and a round number of
/// millimetres, which their labels say.
std::vector<Mark> axes_of(const Bounds& bounds);

}  // namespace ctpm::render
