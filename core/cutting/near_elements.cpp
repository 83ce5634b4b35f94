#include "core/cutting/near_elements.h"

#include <cmath>
#include <numeric>

namespace ctpm::cutting {

NearElements::NearElements(const Model& model)
    : model_(model), found_at_(model.sphere_count()), outside_(model.sphere_count()), near_(model.axial.size()) {
  take_all();
}

void NearElements::take_all() {
  count_ = near_.size();
  std::iota(near_.begin(), near_.end(), 0);
}

void NearElements::find(const Vec3Array& position, const Box& box) {
  found_at_ = position;
  outside_.assign(position.size(), 0);
  const auto mark = [&](const std::vector<double>& x, double low, double high, int side) {
    for (std::size_t i = 0; i < x.size(); ++i)
      outside_[i] = std::uint8_t(outside_[i] | (int(x[i] < low) | int(x[i] > high) << 1) << side);
  };
  mark(position.x, box.low.x - kMargin, box.high.x + kMargin, 0);
  mark(position.y, box.low.y - kMargin, box.high.y + kMargin, 2);
  mark(position.z, box.low.z - kMargin, box.high.z + kMargin, 4);
  count_ = 0;
  // Branch-free: every element is written, and only a near one advances the count. A branch would be mispredicted at
  // every lattice row.
  const AxialElements& axial = model_.axial;
  for (std::size_t i = 0; i < axial.size(); ++i) {
    near_[count_] = std::int32_t(i);
    count_ += (outside_[std::size_t(axial.a[i])] & outside_[std::size_t(axial.b[i])]) == 0;
  }
}

void NearElements::follow(const Vec3Array& position) {
  if (count_ == near_.size()) return;
  const auto moved = [](const std::vector<double>& x, const std::vector<double>& from) {
    int any = 0;
    for (std::size_t i = 0; i < x.size(); ++i) any |= !(std::abs(x[i] - from[i]) <= kMargin);
    return any != 0;
  };
  if (moved(position.x, found_at_.x) || moved(position.y, found_at_.y) || moved(position.z, found_at_.z)) take_all();
}

}  // namespace ctpm::cutting
