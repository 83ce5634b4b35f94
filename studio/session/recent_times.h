#pragma once

#include <algorithm>
#include <vector>

#include "core/model/nearest_rank.h"

namespace ctpm::session {

/// The 99th percentile of the last computing times of ticks, counted anew every kTimes ticks.
class RecentTimes {
 public:
  static constexpr std::size_t kTimes = 500;

  RecentTimes() { times_.reserve(kTimes); }

  /// Adds a tick's time [s]. True if p99() is new.
  bool add(double time) {
    times_.push_back(time);
    if (times_.size() < kTimes) return false;
    const auto place = times_.begin() + std::ptrdiff_t(nearest_rank(0.99, kTimes));
    std::nth_element(times_.begin(), place, times_.end());
    p99_ = *place;
    times_.clear();
    return true;
  }

  double p99() const { return p99_; }  ///< [s]; 0 in the first kTimes ticks

 private:
  std::vector<double> times_;
  double p99_ = 0;
};

}  // namespace ctpm::session
