#pragma once

#include <string>

#include "studio/compare/report.h"

namespace ctpm {

/// The measures and the worst moments as lines for a terminal. `to_see_worst` stands under the moments, if any.
std::string comparison_text(const ComparedSessions& compared, const std::string& to_see_worst);

/// The command that shows the worst moment with one second before and after it; empty if no moment goes beyond a limit.
std::string worst_moment_command(const ComparedSessions& compared);

}  // namespace ctpm
