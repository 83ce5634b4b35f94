#pragma once

#include "recordings/session_reader.h"

namespace ctpm::commands {

/// Warns on stderr, before anything is simulated, that this build computes another physics revision than recorded
/// `session`; silent if it computes the same.
void warn_of_physics(const recordings::SessionReader& session);

}  // namespace ctpm::commands
