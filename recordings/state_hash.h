#pragma once

#include <cstdint>

#include "core/model/state.h"

namespace ctpm::recordings {

/// XXH3-64 over every field of the State, independent of padding and machine. FORMAT.md section 5. Never allocates.
/// Equal hashes mean bit-equal States, up to a chance of 2^-64.
std::uint64_t state_hash(const State& state);

}  // namespace ctpm::recordings
