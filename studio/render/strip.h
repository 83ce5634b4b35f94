#pragma once

#include <string>
#include <vector>

#include "studio/render/frame.h"
#include "studio/render/scene_view.h"

namespace ctpm::render {

/// A moment on the strip.
struct StripMoment {
  double at = 0;  ///< share of the session, in [0, 1]
  Colour colour{1, 1, 1};
};

/// A whole session on one line: its force, its limit, what happens, and where the picture is.
struct Strip {
  std::vector<double> force;  ///< largest in equal parts of the session, from its start to its end [N]
  double top_force = 0;       ///< upper end [N]
  double limit = 0;           ///< beyond which the tissue is damaged [N]; 0: none
  std::vector<StripMoment> moments;
  double now = 0;  ///< share of the session that the picture shows
};

/// The picture with the strip below it, `height` pixels high. The largest force stands in it as a number.
Frame with_strip(const Frame& picture, int height, const Strip& strip);

}  // namespace ctpm::render
