#pragma once

#include <string>

#include "core/model/model.h"
#include "core/model/state.h"

namespace ctpm::recordings::session_file {

// Searches lay grids over what a file says: over the spheres at rest, an organ's lattice, its surface, a swept surface.
// Each function returns what is wrong with their sizes, FORMAT.md section 11; empty if nothing is. Indices are good.

std::string problem_of_lattice(const Model& model, const OrganRange& organ);
std::string problem_of_rest(const Model& model);
std::string problem_of_surface(const Model& model, const OrganRange& organ, const Surface& surface);
std::string problem_of_swept(const State& state);

}  // namespace ctpm::recordings::session_file
