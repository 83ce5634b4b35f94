#pragma once

#include "studio/compare/measures.h"

namespace ctpm::compare {

/// How the trainee's way in the tissue runs beside the expert's: another way than `same` is said where it brings the
/// two closer together than half of what they are apart, and they are more than `noticeable` [m] apart. The planes of
/// mirrors go through `middle` [m].
Way way_of(const SessionTrack& expert, const SessionTrack& trainee, Vec3 middle, double noticeable);

/// What to say about it, in words for the trainee; empty if the way is the same.
const char* to_word(Way way);

}  // namespace ctpm::compare
