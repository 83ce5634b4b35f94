#pragma once

namespace ctpm {

/// Whether everything but springs is left out of the build: the measure of what features cost a scene that has none of
/// them. Never so in a build that is used.
#ifdef CTPM_ONLY_SPRINGS
inline constexpr bool kOnlySprings = true;
#else
inline constexpr bool kOnlySprings = false;
#endif

}  // namespace ctpm
