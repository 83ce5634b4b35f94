#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/film/pipeline.h"
#include "studio/film/session_film.h"
#include "studio/video/video_writer.h"
#include "studio/views/look.h"

namespace ctpm::film {

/// A session as the video shows it.
struct SidecarSession {
  const SessionFilm* film = nullptr;
  const views::Look* look = nullptr;
};

/// What is said of the video as a whole.
struct SidecarFacts {
  video::VideoFacts video;
  StageTimes times;
  std::string pixels_hash;  ///< of all frames before encoding
  double speed = 1;
  std::string opengl;  ///< what drew it
};

/// The JSON beside a video: which sessions it shows, with hash and verdict; video, camera and view; what made
/// it and how long that took. Errors: a session cannot be read for its hash.
Result<std::string> sidecar_text(const std::vector<SidecarSession>& sessions, const SidecarFacts& facts);

}  // namespace ctpm::film
