#pragma once

#include <array>
#include <vector>

#include "recordings/session_reader.h"
#include "studio/compare/report.h"

namespace ctpm::commands {

/// Draws moments of two sessions, of each the trainee's and the expert's seconds, both as the trainee's is seen. The
/// pictures are in the order of `times`. Errors: those of film::draw_stills().
Result<std::vector<compare::MomentPictures>> draw_moments(recordings::SessionReader& trainee,
                                                          recordings::SessionReader& expert,
                                                          const std::vector<std::array<double, 2>>& times,
                                                          bool allow_diverged);

}  // namespace ctpm::commands
