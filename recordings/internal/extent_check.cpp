#include "recordings/internal/extent_check.h"

#include <algorithm>
#include <cmath>

#include "core/cutting/extent.h"
#include "core/cutting/lattice_frame.h"
#include "core/cutting/swept_surface.h"
#include "core/model/box.h"
#include "core/model/fields.h"

namespace ctpm::recordings::session_file {
namespace {

constexpr double most_swept_cells = 2e7;  // those that one part of a swept surface meets, summed over all
constexpr double farthest_swept = 1e3;    // from the origin along an axis [m]

// Sites of a lattice's box: thin organs fill little of theirs.
constexpr double free_sites = 5e5, sites_per_sphere = 100, most_sites = 2e7;

double sites_for(std::int32_t spheres) { return std::min(most_sites, free_sites + sites_per_sphere * spheres); }

}  // namespace

std::string problem_of_lattice(const Model& model, const OrganRange& organ) {
  if (organ.count == 0) return "";
  const auto first = std::size_t(organ.first), last = first + std::size_t(organ.count);
  double sites = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    std::int64_t low = model.cell[first][a], high = low;
    for (std::size_t i = first; i < last; ++i)
      low = std::min<std::int64_t>(low, model.cell[i][a]), high = std::max<std::int64_t>(high, model.cell[i][a]);
    sites *= double(high - low + 1);
  }
  return sites <= sites_for(organ.count) ? "" : "the box of its lattice has more sites than its spheres explain";
}

std::string problem_of_rest(const Model& model) {
  if (model.sphere_count() == 0) return "";
  Box box(model.rest_position[0]);
  for (std::size_t i = 1; i < model.sphere_count(); ++i) box.add(model.rest_position[i]);
  double spacing = 0;
  for (const OrganRange& organ : model.organs) spacing = std::max(spacing, organ.spacing);
  return cutting::rest_fits(box, spacing) ? "" : "the box around all spheres is too large";
}

/// In the axes of the organ's lattice, as the grid that cuts are drawn on.
std::string problem_of_surface(const Model& model, const OrganRange& organ, const Surface& surface) {
  if (surface.vertex.empty()) return "";
  if (organ.count == 0 || !(organ.spacing > 0)) return "belongs to an organ without a lattice";
  Box box(surface.vertex[0]);
  for (const Vec3& vertex : surface.vertex) box.add(vertex);
  const cutting::LatticeFrame frame = cutting::lattice_frame(model, organ);
  const auto first = std::size_t(organ.first), last = first + std::size_t(organ.count);
  double sites = 1;
  bool is_near = true;  // false as well where neighbours lie at one place, which gives no axis
  for (std::size_t a = 0; a < 3; ++a) {
    double low = model.cell[first][a], high = low;
    const auto add = [&](double at) {
      is_near = is_near && std::abs(at) <= 2 * double(kFarthestCell);
      low = std::min(low, at), high = std::max(high, at);
    };
    for (std::size_t i = first; i < last; ++i) add(model.cell[i][a]);
    for (const Vec3& vertex : surface.vertex) add(dot(vertex - frame.origin, frame.axis[a]) / organ.spacing);
    sites *= high - low + 3;
  }
  if (!is_near) return "lies far from the organ's lattice";
  const bool fits =
      cutting::cells_in(box, cutting::kSurfaceCell) <= cutting::kMostCells && sites <= sites_for(organ.count);
  return fits ? "" : "has a larger box than the organ's spheres explain";
}

std::string problem_of_swept(const State& state) {
  const std::size_t rows = cutting::swept_rows(state);
  if (rows > cutting::kMostSweptRows) return "has more than " + std::to_string(cutting::kMostSweptRows) + " rows";
  for (std::size_t i = 0; i < state.swept.size(); ++i) {
    const Vec3 p = state.swept[i];
    if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= farthest_swept)) return "is farther than 1 km";
  }
  double cells = 0;
  for (std::size_t row = 1; row < rows; ++row)
    for (std::size_t n = 0; n + 1 < kEdgeNodes; ++n) {
      const std::size_t at = row * kEdgeNodes + n, before = at - kEdgeNodes;
      if (state.swept_organ[at] == 0) continue;
      cells += cutting::cells_in(
          Box(state.swept[before], state.swept[before + 1], state.swept[at], state.swept[at + 1]), cutting::kRestCell);
    }
  return cells <= most_swept_cells ? "" : "sweeps more than blades can";
}

}  // namespace ctpm::recordings::session_file
