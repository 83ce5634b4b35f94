#include "core/cutting/extent.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

namespace ctpm::cutting {
namespace {

std::optional<Box> box_of(const std::vector<Vec3>& points) {
  if (points.empty()) return {};
  Box box(points.front());
  for (const Vec3& p : points) box.add(p);
  return box;
}

/// "WHAT 1.2 x 0.8 x 0.5 m large; a box of 0.69 m^3 is the most that can be recorded"
std::string too_large(const char* what, const Box& box, double cell) {
  const Vec3 size = box.high - box.low;
  char text[160];
  std::snprintf(text, sizeof text, "%s %.2g x %.2g x %.2g m large; a box of %.2g m^3 is the most that can be recorded",
                what, size.x, size.y, size.z, kMostCells * cell * cell * cell);
  return text;
}

}  // namespace

double cells_in(const Box& box, double cell) {
  const Vec3 size = (box.high - box.low) / cell;
  return (1 + std::ceil(size.x)) * (1 + std::ceil(size.y)) * (1 + std::ceil(size.z));
}

bool rest_fits(const Box& box, double spacing) { return cells_in(box.grown(spacing), kRestCell) <= kMostCells; }

std::string extent_problem(std::span<const FilledOrgan> organs) {
  std::optional<Box> all;
  double spacing = 0;
  for (const FilledOrgan& organ : organs) {
    if (const auto surface = box_of(organ.surface.vertex); surface && cells_in(*surface, kSurfaceCell) > kMostCells)
      return too_large("an organ is", *surface, kSurfaceCell);
    spacing = std::max(spacing, organ.spacing);
    if (const auto spheres = box_of(organ.centre)) {
      if (!all) all = spheres;
      all->add(spheres->low), all->add(spheres->high);
    }
  }
  return all && !rest_fits(*all, spacing) ? too_large("the organs together are", *all, kRestCell) : "";
}

}  // namespace ctpm::cutting
