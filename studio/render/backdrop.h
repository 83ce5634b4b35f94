#pragma once

#include "studio/render/frame.h"

namespace ctpm::render {

/// The studio's backdrop: a soft gradient, brightest behind the scene. A fixed dither prevents banding in a video.
Frame make_backdrop(int width, int height);

}  // namespace ctpm::render
