#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/result.h"

namespace ctpm::render {

/// One picture.
struct Frame {
  int width = 0, height = 0;      ///< [pixels]
  std::vector<std::uint8_t> rgb;  ///< sRGB, row by row, top row first                      (height x width x 3)

  friend bool operator==(const Frame&, const Frame&) = default;
};

/// A frame of one colour.
Frame blank_frame(int width, int height, std::uint8_t red, std::uint8_t green, std::uint8_t blue);

/// Two pictures of equal height side by side, with a thin line between them.
Frame join_beside(const Frame& left, const Frame& right);

/// The bytes of a PNG file. Errors: an empty frame.
Result<std::vector<std::uint8_t>> to_png(const Frame& frame);

/// Writes a PNG file under a temporary name beside `path`, then renames it. Errors: an empty frame, a name that does
/// not end in .png, a folder that cannot be written.
Result<Done> write_png(const std::string& path, const Frame& frame);

/// Reads a PNG file; what is transparent in it, on black. Errors: no file, not a PNG.
Result<Frame> read_png(const std::string& path);

}  // namespace ctpm::render
