#pragma once

#include "recordings/session_reader.h"

namespace ctpm::commands {

/// Warns on stderr if this build computes another physics revision than the one that recorded `session`, and of what
/// this build chose because an older session does not store it. Call it before simulating.
void warn_of_physics(const recordings::SessionReader& session);

}  // namespace ctpm::commands
