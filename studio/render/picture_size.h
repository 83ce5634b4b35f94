#pragma once

#include <cstdio>
#include <string>

#include "core/model/result.h"
#include "studio/output/option_name.h"

namespace ctpm::render {

/// Width and height of pictures [pixels].
struct PictureSize {
  int width = 1280, height = 720;
};

/// Reads `WIDTHxHEIGHT`. Errors: another form; a side outside [64, 8192] or odd, which video codecs do not allow.
inline Result<PictureSize> parse_picture_size(const std::string& text) {
  PictureSize size;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &rest) != 2)
    return Error{output::option_name("picture.size"), "got '" + text + "', must be WIDTHxHEIGHT, for example 1280x720",
                 ""};
  for (const int side : {size.width, size.height})
    if (side < 64 || side > 8192 || side % 2 != 0)
      return Error{output::option_name("picture.size"), "got " + text + ", both sides must be even and in [64, 8192]",
                   ""};
  return size;
}

}  // namespace ctpm::render
