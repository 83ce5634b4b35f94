#include "core/slabs.h"

#include <algorithm>

namespace ctpm {
namespace {

/// Fewer spheres than this are done before a second thread has woken up.
constexpr std::size_t kFewest = 1500;

/// Spheres of a slab whose positions, velocities and forces stay in a core's cache.
constexpr std::size_t kPerSlab = 8192;

}  // namespace

Slabs::Slabs(std::size_t sphere_count) {
  const std::size_t wanted = (sphere_count + kPerSlab - 1) / kPerSlab;
  const std::size_t count = sphere_count < kFewest ? 1 : std::max<std::size_t>(4, (wanted + 3) / 4 * 4);
  for (std::size_t i = 0; i <= count; ++i) begin_.push_back(std::int32_t(sphere_count * i / count));
}

int Slabs::of(std::int32_t sphere) const {
  return int(std::upper_bound(begin_.begin() + 1, begin_.end() - 1, sphere) - (begin_.begin() + 1));
}

Schedule::Schedule(const Slabs& slabs) : task_count_{slabs.count(), slabs.count() / 2, (slabs.count() - 1) / 2, 1} {}

std::pair<int, int> Schedule::place(int lowest_slab, int highest_slab) const {
  if (lowest_slab == highest_slab) return {0, lowest_slab};
  if (highest_slab == lowest_slab + 1) return {1 + lowest_slab % 2, lowest_slab / 2};
  return {3, 0};
}

}  // namespace ctpm
