#pragma once

#include <vector>

#include "studio/compare/report.h"
#include "studio/reports/plot.h"

namespace ctpm::compare {

/// Force and depth over time of both, as far as there is any.
std::vector<reports::Plot> plots_over_time(const ComparedSessions& compared);

/// Paths of the tool from above and from the side, and how far the aligned paths are apart.
std::vector<reports::Plot> plots_of_paths(const ComparedSessions& compared);

/// The cut from above and from the side: where elements were severed by whom. Empty if nobody cut.
std::vector<reports::Plot> plots_of_cut(const ComparedSessions& compared);

}  // namespace ctpm::compare
