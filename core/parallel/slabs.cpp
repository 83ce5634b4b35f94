#include "core/parallel/slabs.h"

#include <algorithm>

namespace ctpm::parallel {
namespace {

/// Below this number of spheres the work is done before a second thread wakes up.
constexpr std::size_t kFewest = 1500;

/// Number of slabs of a small Model and of a large one: that many threads can share its work.
constexpr std::size_t kFewSlabs = 2, kManySlabs = 4;

/// Spheres per slab up to which a Model is small, and beyond which it gets more slabs. Elements between slabs are
/// computed once for each slab, so thick slabs are better.
constexpr std::size_t kThin = 4096, kThick = 32768;

std::size_t count_for(std::size_t spheres) {
  if (spheres < kFewest) return 1;
  return std::max(std::clamp(spheres / kThin, kFewSlabs, kManySlabs), spheres / kThick);
}

}  // namespace

Slabs::Slabs(std::size_t sphere_count) : Slabs(std::vector<SphereRange>{{0, std::int32_t(sphere_count)}}) {}

Slabs::Slabs(const std::vector<SphereRange>& parts) {
  for (const SphereRange& part : parts) add(part);
  set_asleep(std::vector<std::uint8_t>(std::size_t(count())));
}

void Slabs::add(SphereRange spheres) {
  const auto size = std::size_t(spheres.end - spheres.begin), slabs = count_for(size);
  for (std::size_t i = 1; i <= slabs; ++i) begin_.push_back(spheres.begin + std::int32_t(size * i / slabs));
}

void Slabs::set_asleep(const std::vector<std::uint8_t>& asleep) {
  awake_.clear(), asleep_.clear();
  for (int slab = 0; slab < count(); ++slab) (asleep[std::size_t(slab)] != 0 ? asleep_ : awake_).push_back(slab);
}

int Slabs::of(std::int32_t sphere) const {
  return int(std::upper_bound(begin_.begin() + 1, begin_.end() - 1, sphere) - (begin_.begin() + 1));
}

}  // namespace ctpm::parallel
