#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "core/model/result.h"
#include "recordings/event.h"

namespace ctpm::recordings::session_file {

/// Name of a retired number of `solver.integrator`; null if the number is not retired. Retired numbers are never
/// reused.
const char* retired_integrator(std::int32_t number);

/// Updates the Model of an older file. `automatic` becomes the integrator and substeps that this build chooses, and
/// `remarks` reports the choice. `physics_revision` is that of the file; a file that stores it never holds `automatic`.
/// Error: a retired integrator, by name.
/// Gives organs with a surface the modulus that tools dent, which sessions of physics revisions before 3 do not store.
void give_modulus(Model& model);

Result<Done> update_integrator(Model& model, std::int32_t physics_revision, std::vector<std::string>& remarks);

/// Changes a loose piece that is stored as a cut with a sentence to its own kind. Leaves all other events unchanged.
void update_event(Event& event);

}  // namespace ctpm::recordings::session_file
