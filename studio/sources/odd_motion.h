#pragma once

#include <string>

#include "core/model/result.h"
#include "studio/sources/motion_file.h"

namespace ctpm::sources {

/// What is odd about a motion that can be read, each with `file:line`: a tool that moves faster than a
/// hand, a pause in which nothing was written though the tool moved, rows that are seconds apart, and places that seem
/// to be metres.
Errors find_odd_motion(const Motion& motion, const std::string& file);

}  // namespace ctpm::sources
