#include "core/cutbody/cut_points.h"

#include <algorithm>
#include <limits>

#include "core/cutbody/cut_grid.h"

namespace ctpm::cutbody {
namespace {

std::int64_t kinds_of(const Model& model) { return std::int64_t(2 + model.obstacles.size()) + (model.hands - 1); }

}  // namespace

CutPoints::CutPoints(const Model& model)
    : begin_(std::int64_t(model.touchable_count()) * kinds_of(model)),
      kinds_(kinds_of(model)),
      first_(model.organs.size() + 1, 0) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  for (std::size_t organ = 0; organ < model.organs.size(); ++organ) {
    double points = 0;
    if (model.has_scalpel() && model.organs[organ].count > 0 && organ < model.surfaces.size() &&
        !model.surfaces[organ].triangle.empty()) {
      const CutGrid::Node blocks = CutGrid::blocks_of(model, organ);
      points = double(kPerBlock) * blocks[0] * blocks[1] * blocks[2];
    }
    const bool fits = double(begin_) + double(kinds_) * (double(first_[organ]) + points) < kMost;
    first_[organ + 1] = first_[organ] + (fits ? std::int64_t(points) : 0);
  }
}

CutPoints::Place CutPoints::place(std::int32_t point) const {
  const std::int64_t within = (point - begin_) % per_kind();
  const auto next = std::upper_bound(first_.begin(), first_.end(), within);
  const auto organ = std::size_t(next - first_.begin()) - 1;
  const std::int64_t of_organ = within - first_[organ];
  return {organ, std::int32_t(of_organ / kPerBlock), std::int32_t(of_organ % kPerBlock)};
}

}  // namespace ctpm::cutbody
