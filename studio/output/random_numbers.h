#pragma once

#include <cstdint>

namespace ctpm::output {

/// The number of a seed at a place: SplitMix64 (Steele, Lea and Flood 2014) as a function of its counter, so that it
/// depends on no order and no machine, unlike the distributions of the library.
std::uint64_t random_at(std::uint64_t seed, std::uint64_t counter);

}  // namespace ctpm::output
