#include "importers/scan_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace ctpm::importers {
namespace {

/// A crossing of a lattice row and the surface.
struct Crossing {
  double x;             ///< [m]
  std::int32_t enters;  ///< +1: enters the inside, -1: leaves it
};

/// +1 or -1 if the edge from `a` to `b`, projected along x, crosses the ray from (y, z) towards +y upwards or
/// downwards, else 0. The crossing point depends on the edge alone, not on its direction.
int passes(Vec3 a, Vec3 b, double y, double z) {
  const bool goes_up = a.z <= z && z < b.z, goes_down = b.z <= z && z < a.z;
  if (!goes_up && !goes_down) return 0;
  const Vec3 low = goes_up ? a : b, high = goes_up ? b : a;
  const double edge_y = low.y + (z - low.z) * ((high.y - low.y) / (high.z - low.z));
  if (!(edge_y > y)) return 0;
  return goes_up ? 1 : -1;
}

/// x of the triangle's plane at (y, z), clamped to the triangle because the plane may be steep.
double height_over(Vec3 a, Vec3 b, Vec3 c, double y, double z) {
  const Vec3 normal = cross(b - a, c - a);
  const double least = std::min({a.x, b.x, c.x}), most = std::max({a.x, b.x, c.x});
  const double x = a.x - (normal.y * (y - a.y) + normal.z * (z - a.z)) / normal.x;
  return std::isfinite(x) ? std::clamp(x, least, most) : 0.5 * (least + most);
}

/// Calls `on_crossing(row, crossing)` for every crossing of a lattice row and a triangle, triangle by triangle.
template <class OnCrossing>
void for_each_crossing(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle, const RowLines& lines,
                       const OnCrossing& on_crossing) {
  const Lattice& lattice = lines.lattice;
  const Vec3 origin = lattice.at({0, 0, 0});
  const auto first_row = [&](double least, double from, int axis) {
    return std::int32_t(
        std::clamp(std::ceil((least - from) / lattice.spacing) - 1, 0.0, double(lattice.count[axis] - 1)));
  };
  const auto last_row = [&](double most, double from, int axis) {
    return std::int32_t(
        std::clamp(std::floor((most - from) / lattice.spacing) + 1, 0.0, double(lattice.count[axis] - 1)));
  };
  for (const Triangle& t : triangle) {
    const Vec3 a = vertex[std::size_t(t[0])], b = vertex[std::size_t(t[1])], c = vertex[std::size_t(t[2])];
    const std::int32_t j_end = last_row(std::max({a.y, b.y, c.y}), origin.y, 1);
    const std::int32_t k_end = last_row(std::max({a.z, b.z, c.z}), origin.z, 2);
    for (std::int32_t k = first_row(std::min({a.z, b.z, c.z}), origin.z, 2); k <= k_end; ++k)
      for (std::int32_t j = first_row(std::min({a.y, b.y, c.y}), origin.y, 1); j <= j_end; ++j) {
        const Vec3 line = lines.at(j, k);
        const int turns = passes(a, b, line.y, line.z) + passes(b, c, line.y, line.z) + passes(c, a, line.y, line.z);
        // If the corners run counter-clockwise seen from +x, the outside is towards +x.
        if (turns != 0) on_crossing(lattice.row_of({0, j, k}), Crossing{height_over(a, b, c, line.y, line.z), -turns});
      }
  }
}

}  // namespace

Vec3 RowLines::at(std::int32_t j, std::int32_t k) const {
  Vec3 point = lattice.at({0, j, k});
  if (shift == nullptr) return point;
  const auto [y, z] = shift(j, k);
  point.y += y * lattice.spacing, point.z += z * lattice.spacing;
  return point;
}

bool spans_inside(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle, const RowLines& lines,
                  const std::function<void(std::int32_t, std::int32_t, const std::vector<Span>&)>& on_row) {
  const Lattice& lattice = lines.lattice;
  // Store the crossings of each row contiguously: count first, then place.
  std::vector<std::int64_t> first(std::size_t(lattice.row_count()) + 1, 0);
  for_each_crossing(vertex, triangle, lines, [&](std::int64_t row, Crossing) { ++first[std::size_t(row) + 1]; });
  for (std::size_t row = 1; row < first.size(); ++row) first[row] += first[row - 1];
  std::vector<Crossing> crossings(std::size_t(first.back()));
  std::vector<std::int64_t> next(first.begin(), first.end() - 1);
  for_each_crossing(vertex, triangle, lines, [&](std::int64_t row, Crossing crossing) {
    crossings[std::size_t(next[std::size_t(row)]++)] = crossing;
  });

  std::vector<Span> spans;
  bool overlaps = false;
  for (std::int32_t k = 0; k < lattice.count[2]; ++k)
    for (std::int32_t j = 0; j < lattice.count[1]; ++j) {
      const std::size_t row = std::size_t(lattice.row_of({0, j, k}));
      const auto begin = crossings.begin() + first[row], end = crossings.begin() + first[row + 1];
      if (begin == end) continue;
      std::sort(begin, end,
                [](const Crossing& a, const Crossing& b) { return a.x != b.x ? a.x < b.x : a.enters < b.enters; });
      spans.clear();
      std::int32_t winding = 0;
      for (auto crossing = begin; crossing != end; ++crossing) {
        const std::int32_t before = winding;
        winding += crossing->enters;
        overlaps = overlaps || winding > 1;
        if (before <= 0 && winding > 0) spans.push_back({crossing->x, crossing->x});
        if (before > 0 && winding <= 0) spans.back().end = crossing->x;
      }
      on_row(j, k, spans);
    }
  return overlaps;
}

std::vector<Cell> cells_inside(const std::vector<Vec3>& vertex, const std::vector<Triangle>& triangle,
                               const Lattice& lattice) {
  std::vector<Cell> cells;
  spans_inside(vertex, triangle, {lattice}, [&](std::int32_t j, std::int32_t k, const std::vector<Span>& spans) {
    auto span = spans.begin();
    for (std::int32_t i = 0; i < lattice.count[0]; ++i) {
      const double x = lattice.at({i, j, k}).x;
      while (span != spans.end() && span->end < x) ++span;
      if (span == spans.end()) break;
      if (span->begin < x) cells.push_back({i, j, k});
    }
  });
  return cells;
}

}  // namespace ctpm::importers
