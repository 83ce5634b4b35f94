#include "importers/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ctpm::importers {

CellLookup::CellLookup(const Lattice& lattice, const std::vector<Cell>& cell) : lattice_(lattice), cell_(cell) {
  first_.assign(std::size_t(lattice.row_count()) + 1, 0);
  for (const Cell& c : cell) ++first_[std::size_t(lattice.row_of(c)) + 1];
  for (std::size_t row = 1; row < first_.size(); ++row) first_[row] += first_[row - 1];
}

std::int32_t CellLookup::find(const Cell& wanted) const {
  for (int axis = 0; axis < 3; ++axis)
    if (wanted[axis] < 0 || wanted[axis] >= lattice_.count[axis]) return -1;
  const std::size_t row = std::size_t(lattice_.row_of(wanted));
  const auto begin = cell_.begin() + first_[row], end = cell_.begin() + first_[row + 1];
  const auto it = std::lower_bound(begin, end, wanted[0], [](const Cell& c, std::int32_t i) { return c[0] < i; });
  return it != end && (*it)[0] == wanted[0] ? std::int32_t(it - cell_.begin()) : -1;
}

double CellLookup::nearest_squared_distance(Vec3 point) const {
  const double s = lattice_.spacing;
  const Vec3 origin = lattice_.at({0, 0, 0});
  const auto nearest_index = [&](double offset, int axis) {
    return std::int32_t(std::clamp(std::floor(offset / s + 0.5), 0.0, double(lattice_.count[axis] - 1)));
  };
  const std::int32_t j0 = nearest_index(point.y - origin.y, 1), k0 = nearest_index(point.z - origin.z, 2);
  const double i0 = (point.x - origin.x) / s;
  double best = std::numeric_limits<double>::infinity();
  const auto look_at_row = [&](std::int32_t j, std::int32_t k) {
    if (j < 0 || k < 0 || j >= lattice_.count[1] || k >= lattice_.count[2]) return;
    const std::size_t row = std::size_t(lattice_.row_of({0, j, k}));
    const auto begin = cell_.begin() + first_[row], end = cell_.begin() + first_[row + 1];
    const auto it = std::lower_bound(begin, end, i0, [](const Cell& c, double i) { return c[0] < i; });
    const auto consider = [&](const Cell& c) {
      const Vec3 d = lattice_.at(c) - point;
      best = std::min(best, dot(d, d));
    };
    if (it != end) consider(*it);
    if (it != begin) consider(*(it - 1));
  };
  // Search square rings of rows around the point's row. For points in the box, ring n is at least (n - 1/2) spacings
  // away.
  const std::int32_t most = std::max(lattice_.count[1], lattice_.count[2]);
  for (std::int32_t ring = 0; ring <= most; ++ring) {
    const double reach = (ring - 0.5) * s;
    if (ring > 0 && reach * reach > best) break;
    for (std::int32_t a = -ring; a <= ring; ++a) {
      look_at_row(j0 + a, k0 - ring);
      if (ring > 0) look_at_row(j0 + a, k0 + ring);
      if (a > -ring && a < ring) look_at_row(j0 - ring, k0 + a), look_at_row(j0 + ring, k0 + a);
    }
  }
  return best;
}

}  // namespace ctpm::importers
