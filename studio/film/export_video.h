#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/film/pipeline.h"
#include "studio/render/expert_cut.h"
#include "studio/render/picture_size.h"
#include "studio/session/time_range.h"
#include "studio/video/video_writer.h"
#include "studio/views/look.h"

namespace ctpm::film {

inline constexpr std::size_t kLongestCaption = 200;

struct ExportOptions {
  render::PictureSize size;
  double fps = 30;                                  ///< frames per second, in [1, 240]
  double speed = 1;                                 ///< playback speed relative to real time, in [0.001, 1000]
  views::LookRequest look;                          ///< view and camera
  session::TimeRange range;                         ///< part that is shown, see ScheduleOptions; by default all
  std::vector<std::array<double, 2>> matched = {};  ///< see ScheduleOptions
  std::string slow_at;  ///< moments of a single session that are shown slower: see slow_parts()
  /// Words for all of the film in place of what happens, kLongestCaption bytes at most; of a pair of its right half.
  std::string caption = {};
  std::string overlay = "full";  ///< none, small or full: render::OverlayLevel
  std::string inset = {};        ///< small pictures within the picture: see insets_of()
  bool strip = false;            ///< the whole session's force and moments on a line below the picture
  /// Whose tool and way are drawn into the picture of a single session of the same scene; `matched` belongs to both.
  recordings::SessionReader* ghost = nullptr;
  /// Its line and what was cut elsewhere are drawn on the organ of the last session, which is of the expert's scene.
  std::shared_ptr<const render::ExpertCut> expert = nullptr;
  bool overwrite = false;       ///< replaces an existing video or sidecar
  bool allow_diverged = false;  ///< continue if the replay differs from the recording
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  std::function<bool()> should_stop;  ///< asked at every frame
};

/// A session that a video shows.
struct ShownSession {
  session::TickRange ticks;                ///< the ticks shown
  std::int64_t first_different_tick = -1;  ///< first tick whose replay differs from the recording; -1: none
};

struct ExportOutcome {
  video::VideoFacts video;
  std::vector<ShownSession> sessions;  ///< in the order of the request
  StageTimes times;
  std::string pixels_hash;  ///< XXH3-64 of all frames before encoding

  bool same_as_recorded() const {
    for (const ShownSession& session : sessions)
      if (session.first_different_tick >= 0) return false;
    return true;
  }
};

/// Replays one session, or two synchronised side by side, into a video with overlay. Writes a sidecar `<video>.json`,
/// or `video.json` in a folder of pictures, with the video's content and origin (studio/film/README.md). Errors:
/// options out of range, an unknown camera or view, a damaged session, a replay that differs (unless allowed), an
/// output that exists already or cannot be written, stopped. After an error no file is left behind.
Result<ExportOutcome> export_video(const std::vector<recordings::SessionReader*>& sessions, const std::string& path,
                                   const ExportOptions& options);

}  // namespace ctpm::film
