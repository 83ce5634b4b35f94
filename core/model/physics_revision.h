#pragma once

#include <cstdint>

namespace ctpm {

/// Number of the physics that this build computes, >= 1. It rises whenever the same Model, State and Inputs give other
/// bits, in any feature. Builds of one revision replay each other's sessions to the bit; builds of two need not.
/// recordings/FORMAT.md section 10 says for each revision what changed and why; the golden test holds its hashes.
inline constexpr std::int32_t kPhysicsRevision = 23;

}  // namespace ctpm
