#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "core/model/nearest_rank.h"

namespace ctpm::devices {

/// Counts how long samples waited until a tick took them, in bins of 0.1 ms; adding allocates nothing.
class WaitTimes {
 public:
  static constexpr double kBin = 1e-4, kMost = 1;  // [s]; longer waits count as kMost

  void add(double wait_s) {
    const double bin = std::floor(std::clamp(wait_s, 0.0, kMost) / kBin);
    ++bins_[std::min(std::size_t(bin), bins_.size() - 1)], ++count_;
  }

  /// Share of the waits that end in a bin up to `wait_s`, in [0, 1]; 1: there was none.
  double share_within(double wait_s) const {
    const auto bins = std::min(std::size_t(std::llround(wait_s / kBin)), bins_.size());
    const auto within = std::accumulate(bins_.begin(), bins_.begin() + std::ptrdiff_t(bins), std::int64_t{0});
    return count_ > 0 ? double(within) / double(count_) : 1;
  }

  /// The end of the bin in which the smallest wait lies that a `share` of all do not exceed [s]; 0: there was none.
  double at(double share) const {
    if (count_ == 0) return 0;
    const auto place = std::int64_t(nearest_rank(share, std::size_t(count_)));
    std::int64_t seen = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i)
      if ((seen += bins_[i]) > place) return kBin * double(i + 1);
    return 0;
  }

 private:
  std::array<std::int32_t, std::size_t(kMost / kBin)> bins_{};
  std::int64_t count_ = 0;
};

}  // namespace ctpm::devices
