#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/film/pipeline.h"
#include "studio/render/picture_size.h"
#include "studio/session/time_range.h"
#include "studio/video/video_writer.h"
#include "studio/views/look.h"

namespace ctpm::film {

struct ExportOptions {
  render::PictureSize size;
  double fps = 30;              ///< frames per second, in [1, 240]
  double speed = 1;             ///< times real speed, > 0
  views::LookRequest look;      ///< what is shown, and from where
  session::TimeRange range;     ///< part that is shown; its end is that of the longest session if not given
  bool allow_diverged = false;  ///< go on although the replay differs from the recording
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  std::function<bool()> should_stop;  ///< asked at every frame
};

/// A session that a video shows.
struct ShownSession {
  session::TickRange ticks;                ///< that are shown
  std::int64_t first_different_tick = -1;  ///< whose replay differs from the recording; -1: none
};

struct ExportOutcome {
  video::VideoFacts video;
  std::vector<ShownSession> sessions;  ///< in the order that was asked for
  StageTimes times;
  std::string pixels_hash;  ///< XXH3-64 of all frames before encoding

  bool same_as_recorded() const {
    for (const ShownSession& session : sessions)
      if (session.first_different_tick >= 0) return false;
    return true;
  }
};

/// Replays one session, or two side by side in step, into a video with overlay; beside it a sidecar
/// `<video>.json` that says what it shows and how it was made (studio/film/README.md). Errors: options out of
/// range, an unknown camera or view, a damaged session, a replay that differs (unless allowed), an output
/// that cannot be written, stopped. After an error no file is left behind.
Result<ExportOutcome> export_video(const std::vector<recordings::SessionReader*>& sessions, const std::string& path,
                                   const ExportOptions& options);

}  // namespace ctpm::film
