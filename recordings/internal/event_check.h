#pragma once

#include <cstdint>
#include <string>

#include "recordings/event.h"

namespace ctpm::recordings::session_file {

/// What is wrong with an event of a file: its tick is not in [0, last_tick], it links to a tool, an organ or a sphere
/// that the Model lacks, a count is below 0, or a number is not finite. Empty if nothing is.
std::string problem_of(const Event& event, const Model& model, std::int64_t last_tick);

}  // namespace ctpm::recordings::session_file
