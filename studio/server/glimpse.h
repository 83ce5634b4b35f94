#pragma once

#include "core/model/state.h"
#include "recordings/session.h"

namespace ctpm::server {

/// What can be shown of a tick before it is simulated: both hands as they were recorded, and tissue that moves along
/// straight lines from the State `before` to the State `after`, `share` of the way, in [0, 1]. Where the tissue was cut
/// between the two, it is as in the nearer one. It is for the eye alone: no replay can go on from it.
State glimpse_between(const State& before, const State& after, double share, const recordings::TickRecord& record);

}  // namespace ctpm::server
