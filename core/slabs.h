#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/model.h"

namespace ctpm {

/// Spheres in ranges of about equal size that follow their order, which is the lattice's. How many there are depends on
/// the Model alone: sums go slab by slab, and so have the same shape on any number of threads.
class Slabs {
 public:
  explicit Slabs(std::size_t sphere_count);

  int count() const { return int(begin_.size()) - 1; }
  std::int32_t begin(int slab) const { return begin_[std::size_t(slab)]; }
  std::int32_t end(int slab) const { return begin_[std::size_t(slab) + 1]; }
  int of(std::int32_t sphere) const;

 private:
  std::vector<std::int32_t> begin_;  ///< (slab_count + 1)
};

/// Work on elements, which write to all their spheres, in steps within which no two tasks write to the same sphere.
/// First what lies within one slab, then what joins slabs 0-1, 2-3 ..., then 1-2, 3-4 ..., then the rest in one task.
class Schedule {
 public:
  static constexpr int kSteps = 4;

  explicit Schedule(const Slabs& slabs);

  /// Where an element belongs whose spheres lie between these slabs: step and task.
  std::pair<int, int> place(int lowest_slab, int highest_slab) const;

  int task_count(int step) const { return task_count_[step]; }

 private:
  int task_count_[kSteps];
};

}  // namespace ctpm
