#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session.h"

namespace ctpm::recordings::session_file {

/// Checks that a Model can be simulated without reading outside its arrays: lengths match, indices are in range,
/// numbers are finite and in the ranges of core/model/model.h. Returns all problems (the first of each array).
Errors check_model(const Model& model);

/// Checks that a State fits the Model.
Errors check_state(const Model& model, const State& state);

/// Checks that there is one surface per organ or none, and that they can be drawn without reading outside their arrays.
Errors check_surfaces(const Model& model, const std::vector<Surface>& surfaces);

}  // namespace ctpm::recordings::session_file
