#pragma once

#include "core/model/model.h"
#include "core/model/result.h"

namespace ctpm::recordings::session_file {

/// Checks that a Model of a file asks for bounded work and memory: numbers of organs, tools and loads, lengths of
/// names, and the most that the solver may do in one tick. FORMAT.md section 11.
Errors check_sizes(const Model& model);

}  // namespace ctpm::recordings::session_file
