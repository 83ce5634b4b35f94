#pragma once

#include <string>

#include "core/model/result.h"
#include "recordings/replay.h"

namespace ctpm::session {

/// The verdict on a whole session: its ticks, and the events that follow from them.
struct WholeVerdict {
  recordings::Verdict ticks;
  std::string wrong_event;  ///< the first event that is not what its ticks give; empty if none is

  bool same() const { return ticks.same && wrong_event.empty(); }
  std::string text() const;  ///< in one readable sentence
};

/// Replays a session as recordings::verify_session() does, all of it, and finds its events anew: contacts, cuts, pieces
/// that came loose, damage and inversion. Late ticks, notes and what a device did are of the moment, and cannot be.
/// A session without a clean end may lack events. Those of other physics revisions are not compared.
Result<WholeVerdict> verify_whole(recordings::SessionReader& reader, const recordings::VerifyOptions& options = {});

}  // namespace ctpm::session
