#pragma once

#include <functional>
#include <string>

#include "core/model/result.h"
#include "recordings/session_reader.h"

namespace ctpm::recordings {

/// What a rewritten session says about itself in place of what it said.
struct RewrittenSession {
  SessionStart start;  ///< network, State and revision are those of the session; texts and names may differ
  std::string id;      ///< 32 hexadecimal digits
  double created_unix_s = 0;
  std::function<void(Event&)> change_event = {};  ///< may change the texts of an event; empty: none changes
  bool keeps_values = true;                       ///< the further named numbers of its end
};

/// Writes a session anew at `out`, in a new file that shares no page with the old one: ticks, keyframes and their
/// hashes are the same to the bit; a signature, and parts of unknown names, are left out. Errors: the session is
/// damaged; `out` exists or cannot be written. After an error there is no file.
Result<Done> rewrite_session(SessionReader& session, const std::string& out, const RewrittenSession& as);

}  // namespace ctpm::recordings
