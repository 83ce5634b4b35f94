#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/result.h"
#include "recordings/session_reader.h"
#include "studio/render/picture_size.h"
#include "studio/session/time_range.h"
#include "studio/video/video_writer.h"

namespace ctpm {

struct ExportOptions {
  PictureSize size;
  double fps = 30;              ///< frames per second, in [1, 240]
  double speed = 1;             ///< times real speed, > 0
  std::string camera;           ///< name of a camera of the scene; empty: its first one, else a fitted one
  TickRange range;              ///< ticks that are shown
  bool allow_diverged = false;  ///< go on although the replay differs from the recording
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  std::function<bool()> should_stop;  ///< asked at every frame
};

struct ExportOutcome {
  VideoFacts video;
  bool same_as_recorded = true;
};

/// Replays a session into a video with overlay, beside it a sidecar `<video>.json` that says what it shows:
/// session, verdict, frames, codec, size, camera. Errors: options out of range, an unknown camera, a damaged
/// session, a replay that differs (unless allowed), an output that cannot be written, stopped. After an error
/// no file is left behind.
Result<ExportOutcome> export_video(SessionReader& reader, const std::string& path,
                                   const ExportOptions& options);

}  // namespace ctpm
