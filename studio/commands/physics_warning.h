#pragma once

#include "recordings/session_reader.h"

namespace ctpm {

/// Warns on stderr, before anything is simulated, that this build computes another physics revision than recorded
/// `session`; silent if it computes the same.
void warn_of_physics(const SessionReader& session);

}  // namespace ctpm
