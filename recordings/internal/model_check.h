#pragma once

#include <string>
#include <vector>

#include "core/model/result.h"
#include "recordings/session.h"

namespace ctpm::recordings::session_file {

/// Whether a Model can be simulated without reading outside its arrays: lengths fit, indices are in range,
/// numbers are finite and in the ranges that core/model/model.h states. All problems at once (the first of each
/// array).
Errors check_model(const Model& model);

/// Whether a State belongs to the Model.
Errors check_state(const Model& model, const State& state);

/// Whether the surfaces are one per organ, or none, and can be drawn without reading outside their arrays.
Errors check_surfaces(const Model& model, const std::vector<Surface>& surfaces);

}  // namespace ctpm::recordings::session_file
