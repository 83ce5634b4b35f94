#pragma once

#include "core/model/result.h"
#include "core/model/state.h"
#include "recordings/session_reader.h"

namespace ctpm::session {

/// A State of a session with all of its cuts.
struct CutAtEnd {
  State state;
  bool is_same = true;  ///< what was replayed to come there was as recorded
};

/// The last keyframe if nothing is cut after it, else the State after the last tick in which a hand holds a blade or
/// severs anything. Errors: the session is damaged there.
Result<CutAtEnd> cut_at_end(recordings::SessionReader& session);

}  // namespace ctpm::session
