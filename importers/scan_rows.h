#pragma once

#include <functional>
#include <vector>

#include "importers/lattice.h"
#include "importers/mesh.h"

namespace ctpm::importers {

/// A part of a line along x inside a surface.
struct Span {
  double begin, end;  ///< [m]
};

/// Lines along x, one for each lattice row: at its y and z, moved by `shift` of its coordinates j and k.
struct RowLines {
  const Lattice& lattice;
  /// Shift of a row's line from its centre along y and z, as a part of the spacing in [-1/2, 1/2]; null: none.
  std::array<double, 2> (*shift)(std::int32_t j, std::int32_t k) = nullptr;

  Vec3 at(std::int32_t j, std::int32_t k) const;  ///< a point of the line [m]
};

/// Calls `on_row(j, k, spans)` for each line that meets a closed, outward surface, in the order of rows. Spans are
/// where the winding number is above 0, in ascending x. Returns whether the surface encloses any of them twice.
bool spans_inside(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle, const RowLines& lines,
                  const std::function<void(std::int32_t j, std::int32_t k, const std::vector<Span>&)>& on_row);

/// The cells whose centres lie inside a closed, outward surface (winding number above 0), sorted by (k, j, i). Each
/// lattice row is a line that is intersected with the surface. The hit test runs edge by edge with the same arithmetic
/// for both triangles of an edge, so the test is watertight.
std::vector<Cell> cells_inside(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle,
                               const Lattice& lattice);

}  // namespace ctpm::importers
