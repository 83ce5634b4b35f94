#pragma once

#include <string>
#include <vector>

#include "studio/compare/report.h"

namespace ctpm::compare {

/// What the trainee should do better, as sentences with the numbers that show it, the gravest Concern first. Where
/// nothing is beyond a limit: that, and the measure in which most is to be gained. Never empty.
std::vector<std::string> advice_of(const ComparedSessions& compared);

}  // namespace ctpm::compare
