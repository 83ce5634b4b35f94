#include "studio/fidelity/thickness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "importers/text.h"

namespace ctpm::fidelity {
namespace {

using Cell = std::array<std::int32_t, 3>;

/// The nine lines of the lattice through a sphere, one direction of each; the axes first.
constexpr Cell kLines[] = {{1, 0, 0}, {0, 1, 0},  {0, 0, 1}, {1, 1, 0}, {1, -1, 0},
                           {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}};

constexpr std::size_t kAxes = 3;  // the first three lines

constexpr double kGrows = 0.5;  // depth grows by 1 for each unit of way into the tissue, by 0 in the middle of a sheet

Cell moved(Cell cell, Cell way, int count) {
  return {cell[0] + count * way[0], cell[1] + count * way[1], cell[2] + count * way[2]};
}

Vec3 along(Cell way) { return {double(way[0]), double(way[1]), double(way[2])}; }

/// The filled cells of an organ, and what is known along their lines.
class Lines {
 public:
  explicit Lines(const FilledOrgan& organ) : organ_(organ) {
    for (std::size_t i = 0; i < organ.cell.size(); ++i) sphere_at_[organ.cell[i]] = i;
  }

  /// Thickness along a line: the run of spheres, and the depths of its ends [m].
  double run(std::size_t sphere, Cell way) const {
    const double step = organ_.spacing * norm(along(way));
    double length = 0;
    for (const int side : {1, -1}) {
      std::size_t last = sphere;
      for (int n = 1;; ++n) {
        const auto it = sphere_at_.find(moved(organ_.cell[sphere], way, side * n));
        if (it == sphere_at_.end()) break;
        last = it->second, length += step;
      }
      length += organ_.depth[last];
    }
    // Spheres of the covering lattice may lie outside; then the sum can fall below 0.
    return std::max(0.0, length);
  }

  /// Growth of the depth by way, from the neighbours along all lines [1].
  Vec3 growth(std::size_t sphere) const {
    Vec3 sum;
    double count = 0;
    for (const Cell& way : kLines)
      for (const int side : {1, -1}) {
        const auto it = sphere_at_.find(moved(organ_.cell[sphere], way, side));
        if (it == sphere_at_.end()) continue;
        const Vec3 apart = double(side) * organ_.spacing * along(way);
        sum += (organ_.depth[it->second] - organ_.depth[sphere]) / dot(apart, apart) * apart, count += 1;
      }
    // With all eighteen neighbours the sum is six times the gradient: each line gives its own part of it.
    return count > 0 ? 3.0 / count * sum : Vec3{};
  }

 private:
  const FilledOrgan& organ_;
  std::map<Cell, std::size_t> sphere_at_;
};

}  // namespace

std::vector<double> local_thickness(const FilledOrgan& organ) {
  const Lines lines(organ);
  std::vector<double> thickness;
  for (std::size_t i = 0; i < organ.cell.size(); ++i) {
    const Vec3 growth = lines.growth(i);
    double best = std::numeric_limits<double>::infinity(), aligned = 0;
    const bool is_middle = norm(growth) < kGrows;
    for (std::size_t line = 0; line < (is_middle ? kAxes : std::size(kLines)); ++line) {
      const Cell& way = kLines[line];
      const double cosine = std::abs(dot(growth, along(way))) / norm(along(way));
      if (is_middle)
        best = std::min(best, lines.run(i, way));
      else if (cosine > aligned)
        aligned = cosine, best = lines.run(i, way);
    }
    thickness.push_back(best);
  }
  return thickness;
}

ThinParts find_thin_parts(const FilledOrgan& organ) {
  constexpr double kRounding = 1e-3;  // of a spacing
  ThinParts parts;
  // A rig has no surface, and its depths only count layers.
  if (organ.surface.vertex.empty()) return parts;
  const std::vector<double> thickness = local_thickness(organ);
  for (std::size_t i = 0; i < thickness.size(); ++i) {
    if (thickness[i] >= (kLeastSpacingsAcross - kRounding) * organ.spacing) continue;
    if (parts.spheres == 0 || thickness[i] < parts.thinnest)
      parts.thinnest = thickness[i], parts.place = organ.centre[i];
    ++parts.spheres;
  }
  parts.share = thickness.empty() ? 0 : double(parts.spheres) / double(thickness.size());
  return parts;
}

std::string thin_parts_text(const FilledOrgan& organ) {
  const ThinParts thin = find_thin_parts(organ);
  if (thin.spheres == 0) return "";
  const double known = kThicknessError * organ.spacing;
  return std::to_string(thin.spheres) + " of " + std::to_string(organ.centre.size()) +
         " spheres lie in tissue thinner than two spacings (" +
         importers::mm_text(kLeastSpacingsAcross * organ.spacing) + "), which they cannot carry; the thinnest is " +
         (thin.thinnest < known ? "less than " + importers::mm_text(known) : importers::mm_text(thin.thinnest)) +
         " at " + importers::place_text(thin.place);
}

}  // namespace ctpm::fidelity
