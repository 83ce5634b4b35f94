#pragma once

#include <array>
#include <cstdint>

#include "studio/render/frame.h"

namespace ctpm::video {

/// Planes of luma and of both chromas, each chroma in half the width and height; rows are `stride` bytes apart.
struct YuvPlanes {
  std::array<std::uint8_t*, 3> plane;
  std::array<int, 3> stride;
};

/// The frame in the matrix of BT.709 and its narrow range, with the mean chroma of four pixels each. Width and height
/// must be even.
void to_yuv(const render::Frame& frame, const YuvPlanes& yuv);

}  // namespace ctpm::video
