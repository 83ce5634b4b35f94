#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/model/state.h"

namespace ctpm::server {

/// Tells the swept surfaces of one session's States apart. Two that agree in their last rows agree in those before.
class CutKey {
 public:
  CutKey() = default;
  explicit CutKey(const State& state) : points_(state.swept.size()) {
    for (std::size_t n = first_kept(); n < points_; ++n)
      place_.push_back(state.swept[n]), organ_.push_back(state.swept_organ[n]);
  }

  std::size_t points() const { return points_; }  ///< of the swept surface
  bool is_whole() const { return points_ == 0; }  ///< nothing was cut
  bool is_of(const State& state) const { return points_ == state.swept.size() && is_part_of(state); }

  /// Whether `state` has this surface, and may have more.
  bool is_part_of(const State& state) const {
    if (points_ > state.swept.size()) return false;
    for (std::size_t i = 0; i < place_.size(); ++i) {
      const std::size_t n = first_kept() + i;
      if (!(place_[i] == state.swept[n]) || organ_[i] != state.swept_organ[n]) return false;
    }
    return true;
  }

 private:
  std::size_t first_kept() const { return points_ < 2 * kEdgeNodes ? 0 : points_ - 2 * kEdgeNodes; }

  std::size_t points_ = 0;
  std::vector<Vec3> place_;  ///< of the last two rows at rest [m]
  std::vector<std::uint8_t> organ_;
};

}  // namespace ctpm::server
