#pragma once

#include <cstdint>
#include <vector>

#include "core/elements/kernels/kernels.h"

namespace ctpm::elements {

/// How the coupling of one slab's axial elements is split for sweeps through its spheres: the slab is cut into chunks
/// of consecutive spheres, and what couples a sphere with others of the slab belongs to pieces of its chunk. What
/// couples it with another slab is left to lagged().
class Sweeps {
 public:
  /// `batches` are those of the slab with spheres [begin, end).
  Sweeps(const std::vector<AxialBatch>& batches, std::int32_t begin, std::int32_t end);
  Sweeps(const Sweeps&) = delete;  // chunks point to pieces
  Sweeps(Sweeps&&) = default;

  Sweep sweep() const { return {chunks_.data(), chunks_.data() + chunks_.size(), begin_, end_}; }
  const std::vector<AxialBatch>& lagged() const { return lagged_; }

 private:
  std::int32_t begin_, end_;
  std::vector<SweepChunk> chunks_;
  std::vector<SweepPiece> pieces_;
  std::vector<AxialBatch> lagged_;
};

}  // namespace ctpm::elements
