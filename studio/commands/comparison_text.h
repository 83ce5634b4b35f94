#pragma once

#include <string>

#include "studio/compare/report.h"

namespace ctpm::commands {

/// The measures and the worst moments as lines for a terminal. `to_see_worst` follows the moments, if there are any.
std::string comparison_text(const compare::ComparedSessions& compared, const std::string& to_see_worst);

/// The command that shows the worst moment with one second before and after it; empty if no moment exceeds a limit.
std::string worst_moment_command(const compare::ComparedSessions& compared);

}  // namespace ctpm::commands
