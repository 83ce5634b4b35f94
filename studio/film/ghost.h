#pragma once

#include <vector>

#include "core/model/inputs.h"
#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/film/schedule.h"
#include "studio/render/marks.h"

namespace ctpm::film {

/// The tool of another session in the picture of the one that is shown: where it is in each frame, and its whole way.
struct Ghost {
  std::string session = {};       ///< its name
  std::vector<Hand> hand;         ///< the first one                  (frame_count)
  std::vector<render::Mark> way;  ///< of its tool's tip, one line for each time it was held
};

/// Reads it from the recording; nothing is replayed. Errors: a damaged session.
Result<Ghost> ghost_of(recordings::SessionReader& session, const FrameTicks& ticks);

}  // namespace ctpm::film
