#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/model/state.h"

namespace ctpm::server {

/// Tells the swept surfaces of one session's States apart. Two that agree in a row agree in those before. The last row
/// still moves while a blade goes on.
class CutKey {
 public:
  CutKey() = default;
  explicit CutKey(const State& state) : points_(state.swept.size()) {
    for (std::size_t n = first_kept(); n < points_; ++n)
      place_.push_back(state.swept[n]), organ_.push_back(state.swept_organ[n]);
  }

  std::size_t points() const { return points_; }  ///< of the swept surface
  bool is_whole() const { return points_ == 0; }  ///< nothing was cut
  bool is_of(const State& state) const { return points_ == state.swept.size() && agrees(state, place_.size()); }

  /// Whether `state` has this surface, but for its last row, and may have more.
  bool is_part_of(const State& state) const {
    return points_ <= state.swept.size() && agrees(state, place_.size() - std::min(kEdgeNodes, place_.size()));
  }

 private:
  /// Whether the first `count` points of those that are kept are those of `state`.
  bool agrees(const State& state, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t n = first_kept() + i;
      if (!(place_[i] == state.swept[n]) || organ_[i] != state.swept_organ[n]) return false;
    }
    return true;
  }
  std::size_t first_kept() const { return points_ < 2 * kEdgeNodes ? 0 : points_ - 2 * kEdgeNodes; }

  std::size_t points_ = 0;
  std::vector<Vec3> place_;  ///< of the last two rows at rest [m]
  std::vector<std::uint8_t> organ_;
};

}  // namespace ctpm::server
