#include "core/cutbody/rest_bins.h"

#include <algorithm>

#include "core/model/box.h"

namespace ctpm::cutbody {

RestBins::RestBins(const Model& model, const OrganRange& organ) : model_(model), organ_(organ) {
  const auto first = std::size_t(organ.first), last = first + std::size_t(organ.count);
  if (first == last) {
    first_.assign(2, 0);
    return;
  }
  Box box(model.rest_position[first]);
  for (std::size_t i = first; i < last; ++i) box.add(model.rest_position[i]);
  low_ = box.low;
  const Vec3 size = box.high - box.low;
  count_ = {1 + Index(size.x / organ.spacing), 1 + Index(size.y / organ.spacing), 1 + Index(size.z / organ.spacing)};
  first_.assign(number({0, 0, count_[2]}) + 1, 0);
  for (std::size_t i = first; i < last; ++i) ++first_[number(bin(model.rest_position[i])) + 1];
  for (std::size_t b = 0; b + 1 < first_.size(); ++b) first_[b + 1] += first_[b];
  sphere_.resize(std::size_t(organ.count));
  std::vector<Index> next(first_.begin(), first_.end() - 1);
  for (Index s = 0; s < organ.count; ++s)
    sphere_[std::size_t(next[number(bin(model.rest_position[std::size_t(organ.first + s)]))]++)] = s;
}

/// The nearest one, of a place beyond all.
RestBins::Bin RestBins::bin(Vec3 rest) const {
  const Vec3 off = (rest - low_) / organ_.spacing;
  const auto along = [](double by, Index count) { return Index(std::clamp(by, 0.0, double(count - 1))); };
  return {along(off.x, count_[0]), along(off.y, count_[1]), along(off.z, count_[2])};
}

}  // namespace ctpm::cutbody
