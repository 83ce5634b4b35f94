#pragma once

#include <cstdint>

#include "core/model/result.h"
#include "core/model/state.h"
#include "recordings/session.h"
#include "recordings/session_reader.h"
#include "studio/server/moments.h"

namespace ctpm::server {

/// What can be shown of a tick before it is simulated: both hands as they were recorded, and tissue that moves along
/// straight lines from the State `before` to the State `after`, `share` of the way, in [0, 1]. Where the tissue was cut
/// between the two, it is as in the nearer one. It is for the eye alone: no replay can go on from it.
State glimpse_between(const State& before, const State& after, double share, const recordings::TickRecord& record);

/// Finds what is known of the moments of a session without a simulation. Not thread-safe.
class Glimpses {
 public:
  /// `reader` and `moments`, of the same session, must outlive this.
  Glimpses(recordings::SessionReader& reader, Moments& moments) : reader_(reader), moments_(moments) {}

  struct Glimpse {
    State state;
    recordings::TickRecord record;
  };
  /// What is known of the State before `tick`, > 0; see glimpse_between(). Errors: a damaged part.
  Result<Glimpse> of(std::int64_t tick);

 private:
  recordings::SessionReader& reader_;
  Moments& moments_;
};

}  // namespace ctpm::server
