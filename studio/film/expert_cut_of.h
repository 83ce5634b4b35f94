#pragma once

#include <memory>
#include <vector>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/film/export_video.h"
#include "studio/render/expert_cut.h"

namespace ctpm::film {

/// All that an expert cut in a session, to be shown on a trainee's organ. Errors: the session is damaged at its end.
Result<std::shared_ptr<const render::ExpertCut>> expert_cut_of(recordings::SessionReader& expert);

/// Brings the second of two sessions of one scene into a film of both: with `is_ghost` as the ghost of the first one,
/// and not beside it. With `has_line`, the organ of the trainee, which is the first one where the expert is a ghost,
/// shows what the expert cut. Errors: the session of the expert is damaged at its end, and there is no line.
Result<Done> pair_up(std::vector<recordings::SessionReader*>& sessions, bool is_ghost, bool has_line,
                     ExportOptions& options);

}  // namespace ctpm::film
