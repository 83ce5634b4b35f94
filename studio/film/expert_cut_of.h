#pragma once

#include <memory>

#include "core/model/result.h"
#include "recordings/session_reader.h"
#include "studio/render/expert_cut.h"

namespace ctpm::film {

/// All that an expert cut in a session, to be shown on a trainee's organ. Errors: the session is damaged at its end.
Result<std::shared_ptr<const render::ExpertCut>> expert_cut_of(recordings::SessionReader& expert);

}  // namespace ctpm::film
