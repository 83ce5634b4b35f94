#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/film/export_video.h"
#include "studio/render/frame.h"

namespace ctpm::film {

/// Pictures of single moments, each with a caption in letters that small pictures can hold.
struct StillsRequest {
  std::vector<std::int64_t> ticks;       ///< whose State before them is shown; never decreasing, not empty
  std::vector<std::int64_t> since = {};  ///< ticks before each of them of whose events its `words` tell; empty: of none
};
using StillCaption = std::function<std::string(std::int64_t tick, const std::string& words)>;

/// Draws moments of sessions, one request for each; all are seen as the first one is. ExportOptions: the size of a
/// picture, look, allow_diverged, progress and should_stop. Errors: a look that the scene does not have, a damaged
/// session, a replay that differs (unless allowed), stopped.
Result<std::vector<std::vector<render::Frame>>> draw_stills(const std::vector<recordings::SessionReader*>& sessions,
                                                            const std::vector<StillsRequest>& requests,
                                                            const StillCaption& caption, const ExportOptions& options);

/// Writes the picture that a film of these sessions has when the first one is at a moment, in seconds. `path` ends in
/// .png. Errors: those of draw_stills(), a moment outside the first session, a file that exists already.
Result<Done> write_still(const std::vector<recordings::SessionReader*>& sessions, const std::string& path, double at_s,
                         const ExportOptions& options);

}  // namespace ctpm::film
