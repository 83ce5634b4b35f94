#pragma once

#include <cstddef>
#include <vector>

namespace ctpm::sweep {

struct Spread {
  std::size_t count = 0;  ///< of finite values
  double mean = 0, deviation = 0, least = 0, most = 0;
};

/// Of the finite values; the deviation is that of a sample, 0 for one value.
Spread spread_of(const std::vector<double>& values);

/// Spearman's rank correlation over the pairs that are both finite, in [-1, 1]; equal values share their mean rank.
/// NaN for fewer than three pairs, and where one of the two never changes.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace ctpm::sweep
