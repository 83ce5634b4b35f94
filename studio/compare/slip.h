#pragma once

#include <string_view>

#include "studio/compare/measures.h"

namespace ctpm::compare {

/// Whether a measure tells of time; smoothness does as well.
bool depends_on_time(std::string_view key);

/// Takes back the measures that depend on time from a comparison in which a session lacks real time, with the reason in
/// their notes: a hand looks faster and smoother than it was.
void refuse_times(Comparison& comparison, const SessionTrack& expert, const SessionTrack& trainee);

}  // namespace ctpm::compare
