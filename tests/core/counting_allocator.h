#pragma once

#include <atomic>

namespace ctpm::testing {

/// Calls of operator new so far, and bytes allocated now. Linking counting_allocator.cpp replaces the allocator of the
/// whole program.
extern std::atomic<long> allocations, live_bytes;

}  // namespace ctpm::testing
