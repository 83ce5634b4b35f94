#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace ctpm {

/// The place in ascending order, from 0, of the smallest of `count` > 0 values that at least a `share` of all do not
/// exceed: percentiles by nearest rank are values that were measured.
inline std::size_t nearest_rank(double share, std::size_t count) {
  return std::size_t(std::clamp(std::ceil(share * double(count)), 1.0, double(count))) - 1;
}

/// That value; 0 of none.
template <class T>
double percentile(std::vector<T> values, double share) {
  if (values.empty()) return 0;
  const auto place = values.begin() + std::ptrdiff_t(nearest_rank(share, values.size()));
  std::nth_element(values.begin(), place, values.end());
  return double(*place);
}

}  // namespace ctpm
