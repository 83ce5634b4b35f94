#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"

namespace ctpm::video {

/// Words for a part of a video.
struct Caption {
  double from_s = 0, to_s = 0;  ///< [s], from < to
  std::string text;             ///< UTF-8, in lines
  bool is_chapter = true;       ///< its beginning is a chapter of that name
};

/// Adds a subtitle track (3GPP timed text) and chapters to a complete MP4 file whose index is at its end. `captions`
/// are in order and do not overlap; the first one is the video's title, too. The pictures stay as they are. Errors: the
/// file has another form or cannot be written.
Result<Done> add_captions(const std::string& path, const std::vector<Caption>& captions);

}  // namespace ctpm::video
