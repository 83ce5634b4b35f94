#pragma once

#include <vector>

#include "studio/compare/report.h"
#include "studio/reports/plot.h"

namespace ctpm::compare {

/// Force and depth of both sessions over time, where there is any: of what is pushed, and of a blade.
std::vector<reports::Plot> plots_over_time(const ComparedSessions& compared);

/// Where a page shows the worst moments: number (from 1) to the place in it.
std::string place_of_moment(std::size_t number);

/// How far each probe of the scene is moved, over time. Empty if there is none, or a session was not replayed whole.
std::vector<reports::Plot> plots_of_probes(const ComparedSessions& compared);

/// The tool's paths from above and from the side, and the distance of the aligned paths.
std::vector<reports::Plot> plots_of_paths(const ComparedSessions& compared);

/// The severed elements of each session from above and from the side. Empty if nobody cut.
std::vector<reports::Plot> plots_of_cut(const ComparedSessions& compared);

}  // namespace ctpm::compare
