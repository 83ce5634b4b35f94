#pragma once

#include <cstdint>
#include <vector>

#include "core/model/model.h"
#include "core/parallel/team.h"

namespace ctpm::parallel {

/// Spheres [begin, end).
struct SphereRange {
  std::int32_t begin, end;
  friend bool operator==(const SphereRange&, const SphereRange&) = default;
};

/// Partition of the spheres into ranges of about equal size, in the order of the lattice. Their number depends on the
/// Model alone. Sums go slab by slab, and so have the same shape on any number of threads. Slabs that sleep are left
/// out of a tick; all are awake at first.
class Slabs {
 public:
  explicit Slabs(std::size_t sphere_count);

  /// Slabs of one of `parts` alone each. The parts partition the spheres, in ascending order.
  explicit Slabs(const std::vector<SphereRange>& parts);

  int count() const { return int(begin_.size()) - 1; }
  std::int32_t begin(int slab) const { return begin_[std::size_t(slab)]; }
  std::int32_t end(int slab) const { return begin_[std::size_t(slab) + 1]; }
  int of(std::int32_t sphere) const;

  /// Decides which slabs are awake; `asleep`: 1: that slab sleeps  (slab_count).
  void set_asleep(const std::vector<std::uint8_t>& asleep);
  const std::vector<int>& awake() const { return awake_; }    ///< ascending
  const std::vector<int>& asleep() const { return asleep_; }  ///< ascending

  /// Calls task(slab) once for each slab that is awake, possibly in parallel.
  template <class Task>
  void for_each_awake(Team& team, Task&& task) const {
    team.for_each(int(awake_.size()), [&](int i) { task(awake_[std::size_t(i)]); });
  }
  template <class Task>
  void for_each_asleep(Team& team, Task&& task) const {
    team.for_each(int(asleep_.size()), [&](int i) { task(asleep_[std::size_t(i)]); });
  }

 private:
  void add(SphereRange spheres);

  std::vector<std::int32_t> begin_{0};  ///< (slab_count + 1)
  std::vector<int> awake_, asleep_;
};

}  // namespace ctpm::parallel
