#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/model/result.h"
#include "studio/film/session_film.h"
#include "studio/render/frame.h"

namespace ctpm::film {

/// How long each stage of an export worked, waiting left out [s]. The stages run at the same time, so that
/// their sum may exceed `elapsed`.
struct StageTimes {
  double simulation = 0, rendering = 0, encoding = 0;
  double elapsed = 0;  ///< from the first frame's beginning to the last one's end

  double work() const { return simulation + rendering + encoding; }
};

/// What is done for each frame.
struct FilmWork {
  std::vector<std::function<Result<Shot>(std::int64_t frame)>> shoot;  ///< one thread for each session
  std::function<Result<render::Frame>(std::vector<Shot> shots)> draw;  ///< in the caller's thread
  std::function<Result<Done>(const render::Frame& frame)> encode;      ///< one thread
};

/// Shots and frames that wait at most between two stages: enough to even out, and little memory.
inline constexpr std::size_t kFilmQueue = 4;

/// Simulates, draws and encodes `frames` frames, the three at the same time, in order, with at most
/// kFilmQueue things waiting for each stage. Errors: the first one of any stage; all have stopped then.
Result<StageTimes> run_film(std::int64_t frames, const FilmWork& work);

}  // namespace ctpm::film
