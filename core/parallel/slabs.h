#pragma once

#include <cstdint>
#include <vector>

#include "core/model/model.h"

namespace ctpm::parallel {

/// Partition of the spheres into ranges of about equal size, in the order of the lattice. Their number depends on the
/// Model alone. Sums go slab by slab, and so have the same shape on any number of threads.
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

}  // namespace ctpm::parallel
