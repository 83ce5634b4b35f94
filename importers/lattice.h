#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/model/vec3.h"

namespace ctpm::importers {

using Cell = std::array<std::int32_t, 3>;  // i, j, k

/// A cubic lattice that is symmetric about a point and whose cells cover a box.
struct Lattice {
  Vec3 centre;         ///< [m]
  double spacing = 0;  ///< [m]
  Cell count{};        ///< cells along each axis

  Vec3 at(const Cell& c) const {
    const auto along = [&](double middle, int axis) {
      return middle + 0.5 * spacing * double(2 * std::int64_t(c[axis]) - (count[axis] - 1));
    };
    return {along(centre.x, 0), along(centre.y, 1), along(centre.z, 2)};
  }
  std::int64_t row_count() const { return std::int64_t(count[1]) * count[2]; }
  std::int64_t row_of(const Cell& c) const { return std::int64_t(c[2]) * count[1] + c[1]; }
};

/// Finds spheres by lattice cell. Each lattice row (equal j and k) is a run in the sorted list of cells.
class CellLookup {
 public:
  /// `cell` is sorted by (k, j, i) and must outlive the lookup.
  CellLookup(const Lattice& lattice, const std::vector<Cell>& cell);

  /// The sphere in a cell, or -1.
  std::int32_t find(const Cell& wanted) const;
  /// Squared distance from a point to the nearest sphere centre [m^2]. Needs at least one sphere.
  double nearest_squared_distance(Vec3 point) const;

 private:
  const Lattice& lattice_;
  const std::vector<Cell>& cell_;
  std::vector<std::int32_t> first_;  ///< index of the first sphere of each row (row_count + 1)
};

}  // namespace ctpm::importers
