#include "core/parallel/slabs.h"

#include <algorithm>

namespace ctpm::parallel {
namespace {

/// Fewer spheres than this are done before a second thread has woken up.
constexpr std::size_t kFewest = 1500;

/// Slabs of a small Model and of a large one, so that as many threads share its work.
constexpr std::size_t kFewSlabs = 2, kManySlabs = 4;

/// Spheres per slab up to which a Model is small, and beyond which there are more slabs still: elements between slabs
/// are worked on once for each, so slabs are better thick.
constexpr std::size_t kThin = 4096, kThick = 32768;

std::size_t count_for(std::size_t spheres) {
  if (spheres < kFewest) return 1;
  return std::max(std::clamp(spheres / kThin, kFewSlabs, kManySlabs), spheres / kThick);
}

}  // namespace

Slabs::Slabs(std::size_t sphere_count) {
  const std::size_t count = count_for(sphere_count);
  for (std::size_t i = 0; i <= count; ++i) begin_.push_back(std::int32_t(sphere_count * i / count));
}

int Slabs::of(std::int32_t sphere) const {
  return int(std::upper_bound(begin_.begin() + 1, begin_.end() - 1, sphere) - (begin_.begin() + 1));
}

}  // namespace ctpm::parallel
