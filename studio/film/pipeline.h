#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/model/result.h"
#include "studio/film/session_film.h"
#include "studio/render/frame.h"

namespace ctpm::film {

/// Working time of each stage of an export, without waiting [s]. The stages run in parallel, so that their sum may
/// exceed `elapsed`.
struct StageTimes {
  double simulation = 0, rendering = 0, encoding = 0;
  double elapsed = 0;  ///< from the start of the first frame to the end of the last

  double work() const { return simulation + rendering + encoding; }
};

/// The work for each frame.
struct FilmWork {
  std::vector<std::function<Result<Shot>(std::int64_t frame)>> shoot;  ///< one thread for each session
  std::function<Result<render::Frame>(std::vector<Shot> shots)> draw;  ///< in the caller's thread
  std::function<Result<Done>(const render::Frame& frame)> encode;      ///< one thread
};

/// Capacity of the queue between two stages: enough to even out their times with little memory.
inline constexpr std::size_t kFilmQueue = 4;

/// Simulates, draws and encodes `frames` frames in order. The three stages run in parallel and at most kFilmQueue
/// things wait for each. Errors: the first one of any stage, after all have stopped.
Result<StageTimes> run_film(std::int64_t frames, const FilmWork& work);

}  // namespace ctpm::film
