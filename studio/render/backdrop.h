#pragma once

#include "studio/render/frame.h"

namespace ctpm::render {

/// The studio's backdrop: a soft gradient, brightest behind the scene, with a fixed dither that hides bands
/// in a video.
Frame make_backdrop(int width, int height);

}  // namespace ctpm::render
