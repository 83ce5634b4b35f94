#pragma once

#include <cstdint>
#include <vector>

#include "core/model/model.h"

namespace ctpm::cutbody {

/// Numbers, in State::touched, of points of the surfaces that cuts change. They come after all others: for each kind of
/// contact (0: with a ball, 1: with tissue, 2 + i: with obstacle i, and last with the second hand's ball) those of all
/// organs that a blade can cut, by block of their grids (CutGrid).
class CutPoints {
 public:
  /// Vertices of one block's surface that have numbers; what is beyond them is not touched.
  static constexpr std::int32_t kPerBlock = 2048;

  explicit CutPoints(const Model& model);

  /// Whether the organ's cuts can be touched: the scene has a blade, the organ a surface, and 32 bits hold its points.
  bool has(std::size_t organ) const { return organ + 1 < first_.size() && first_[organ] < first_[organ + 1]; }
  /// The first point of a block.
  std::int32_t at(std::int32_t kind, std::size_t organ, std::int32_t block) const {
    return std::int32_t(begin_ + kind * per_kind() + first_[organ] + std::int64_t{kPerBlock} * block);
  }
  /// Where a point belongs.
  struct Place {
    std::size_t organ;
    std::int32_t block, vertex;
  };
  bool contains(std::int32_t point) const { return point >= begin_ && point < end(); }
  /// Whether the ball in a hand touches the point of a cut.
  bool is_of_ball(std::int32_t point, std::size_t hand) const {
    const std::int64_t first = begin_ + kind_of_ball(hand) * per_kind();
    return point >= first && point < first + per_kind();
  }
  /// The kind of contact with the ball in a hand. The points of whole surfaces are numbered by the same kinds.
  std::int32_t kind_of_ball(std::size_t hand) const { return hand == 0 ? 0 : std::int32_t(kinds_ - 1); }
  Place place(std::int32_t point) const;
  /// Number of all points of a Model, of cuts or not: each is below it.
  std::int64_t end() const { return begin_ + kinds_ * per_kind(); }

 private:
  std::int64_t per_kind() const { return first_.back(); }

  std::int64_t begin_, kinds_;
  std::vector<std::int64_t> first_;  ///< point of each organ within a kind (organ_count + 1)
};

}  // namespace ctpm::cutbody
