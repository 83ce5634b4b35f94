#include "core/slabs.h"

#include <algorithm>

namespace ctpm {
namespace {

/// Fewer spheres than this are done before a second thread has woken up.
constexpr std::size_t kFewest = 1500;

/// Slabs a Model has at the least, so that as many threads share its work.
constexpr std::size_t kLeastCount = 4;

/// Spheres per slab beyond which there are more slabs: elements between slabs are worked on once for each, so slabs are
/// better thick.
constexpr std::size_t kPerSlab = 32768;

}  // namespace

Slabs::Slabs(std::size_t sphere_count) {
  const std::size_t count = sphere_count < kFewest ? 1 : std::max(kLeastCount, sphere_count / kPerSlab);
  for (std::size_t i = 0; i <= count; ++i) begin_.push_back(std::int32_t(sphere_count * i / count));
}

int Slabs::of(std::int32_t sphere) const {
  return int(std::upper_bound(begin_.begin() + 1, begin_.end() - 1, sphere) - (begin_.begin() + 1));
}

}  // namespace ctpm
