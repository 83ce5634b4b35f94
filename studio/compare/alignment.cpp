#include "studio/compare/alignment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/model/result.h"

namespace ctpm::compare {
namespace {

/// The predecessor of a pair on the best alignment.
enum class From : std::uint8_t { start, both, a_only, b_only };

/// The columns of one row that lie in the band.
struct Row {
  std::size_t first = 0, count = 0;
  bool has(std::size_t column) const { return column >= first && column - first < count; }
};

/// Rows of the band around the diagonal; neighbouring rows overlap, so that an alignment exists.
std::vector<Row> band_rows(std::size_t rows, std::size_t columns, double band) {
  const double slope = rows > 1 ? double(columns - 1) / double(rows - 1) : 0;
  const double half = rows > 1 ? std::max(band * double(std::max(rows, columns)), slope + 1) : double(columns);
  std::vector<Row> result;
  for (std::size_t i = 0; i < rows; ++i) {
    const double middle = slope * double(i);
    const double first = std::max(0.0, std::ceil(middle - half));
    const double last = std::min(double(columns - 1), std::floor(middle + half));
    result.push_back({std::size_t(first), std::size_t(last - first) + 1});
  }
  return result;
}

}  // namespace

Alignment align_paths(std::span<const Vec3> a, std::span<const Vec3> b, double band) {
  CTPM_CHECK(!a.empty() && !b.empty(), "paths that are aligned have points");
  const std::vector<Row> rows = band_rows(a.size(), b.size(), band);
  std::vector<std::vector<From>> from(a.size());
  std::vector<double> before, now;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Row row = rows[i];
    now.assign(row.count, INFINITY);
    from[i].assign(row.count, From::start);
    const auto cost_before = [&](std::size_t j) {
      return i > 0 && rows[i - 1].has(j) ? before[j - rows[i - 1].first] : INFINITY;
    };
    for (std::size_t j = row.first; j < row.first + row.count; ++j) {
      const double cost = norm(a[i] - b[j]);
      const double both = (j > 0 ? cost_before(j - 1) : INFINITY) + 2 * cost, a_only = cost_before(j) + cost;
      const double b_only = (j > row.first ? now[j - 1 - row.first] : INFINITY) + cost;
      const double least = i == 0 && j == 0 ? 2 * cost : std::min({both, a_only, b_only});
      now[j - row.first] = least;
      if (i == 0 && j == 0) continue;
      from[i][j - row.first] = least == both ? From::both : least == a_only ? From::a_only : From::b_only;
    }
    std::swap(before, now);
  }

  Alignment alignment;
  alignment.mean = before.back() / double(a.size() + b.size());
  std::size_t i = a.size() - 1, j = b.size() - 1;
  while (true) {
    alignment.pairs.push_back({i, j, norm(a[i] - b[j])});
    const From step = from[i][j - rows[i].first];
    if (step == From::start) break;
    if (step != From::b_only) --i;
    if (step != From::a_only) --j;
  }
  std::reverse(alignment.pairs.begin(), alignment.pairs.end());
  for (const AlignedPair& pair : alignment.pairs) alignment.largest = std::max(alignment.largest, pair.distance);
  return alignment;
}

}  // namespace ctpm::compare
