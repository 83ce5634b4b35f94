#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "recordings/event.h"

namespace ctpm::recordings::session_file {

/// What a number of `solver.integrator` stood for before it was retired; null if it never was. Retired numbers are
/// never used again.
const char* retired_integrator(std::int32_t number);

/// Brings a Model of an older file to what this program knows: `automatic` becomes the integrator and the substeps that
/// this build chooses, which `remarks` then says. `physics_revision` is that of the file: one that stores it never
/// holds `automatic`. Errors: an integrator that the program no longer has, by name.
Result<Done> update_integrator(Model& model, std::int32_t physics_revision, std::vector<std::string>& remarks);

/// Gives a piece that came loose its own kind, where it is stored as a cut with a sentence. All other events stay as
/// they are.
void update_event(Event& event);

}  // namespace ctpm::recordings::session_file
