#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "studio/film/pipeline.h"
#include "studio/film/session_film.h"
#include "studio/video/video_writer.h"
#include "studio/views/look.h"

namespace ctpm::film {

/// A session and its view in the video.
struct SidecarSession {
  const SessionFilm* film = nullptr;
  const views::Look* look = nullptr;
};

/// Facts about the whole video.
struct SidecarFacts {
  video::VideoFacts video;
  StageTimes times;
  std::string pixels_hash;  ///< of all frames before encoding
  double speed = 1;
  std::string opengl;  ///< name and version of the OpenGL implementation
};

/// Where a video's sidecar lies: beside the file, or in the folder of pictures.
std::string sidecar_of(const std::string& video);

/// The JSON beside a video: its sessions with hash and verdict; video, camera and view; the program that made it and
/// the time that this took. Errors: a session file cannot be read for its hash.
Result<std::string> sidecar_text(const std::vector<SidecarSession>& sessions, const SidecarFacts& facts);

}  // namespace ctpm::film
