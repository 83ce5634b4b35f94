#include "core/inversion/cell_check.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/inversion/corner.h"

namespace ctpm::inversion {
namespace {

/// Deviation of an edge at rest from an axis of the world, over its length, up to which it lies along that axis.
constexpr double kAlong = 1e-9;

/// The lower and the upper corner of edge `e` of a cell along axis 0, 1 or 2.
std::pair<std::size_t, std::size_t> corners_of(std::size_t axis, std::size_t e) {
  const std::size_t bit = std::size_t{1} << axis, low = e & (bit - 1), lower = low | (e - low) << 1;
  return {lower, lower | bit};
}

Vec3 edge_between(const Vec3Array& position, std::int32_t a, std::int32_t b) {
  return position[std::size_t(b)] - position[std::size_t(a)];
}

bool lies_along(Vec3 edge, std::size_t axis) {
  const double parts[3] = {edge.x, edge.y, edge.z}, along = parts[axis];
  const double across = std::abs(parts[(axis + 1) % 3]) + std::abs(parts[(axis + 2) % 3]);
  return along > 0 && across <= kAlong * along;
}

/// An edge of a cell of a batch, in the order in which edges are joined.
struct Edge {
  std::int32_t apart, axis, a;  ///< a: first sphere; the second is `apart` later
  std::int32_t batch;
  auto operator<=>(const Edge&) const = default;
};

/// Edges that share a row.
struct Run {
  elements::EdgeRow edges;
  std::set<std::int32_t> users;  ///< batches
};

/// Joins sorted edges. An edge occurs once for each of its batches.
std::vector<Run> join(const std::vector<Edge>& sorted) {
  std::vector<Run> runs;
  for (const Edge& edge : sorted) {
    const bool is_new =
        runs.empty() || runs.back().edges.axis != edge.axis || runs.back().edges.b - runs.back().edges.a != edge.apart;
    const std::int32_t place = is_new ? -1 : edge.a - runs.back().edges.a, count = is_new ? 0 : runs.back().edges.count;
    if (is_new || place > count || place == elements::kEdges)
      runs.push_back({{1, edge.axis, edge.a, edge.a + edge.apart}, {}});
    else
      runs.back().edges.count = place + 1;
    runs.back().users.insert(edge.batch);
  }
  return runs;
}

/// Whether the volumes at rest differ by rounding only, so that cells can share a batch.
bool are_alike(double a, double b) { return std::abs(a - b) <= 1e-9 * a; }

}  // namespace

CellCheck::CellCheck(const Model& model, const parallel::Slabs& slabs, const elements::Kernels& kernels)
    : model_(model), kernels_(kernels), edge_threshold_((1 + 1e-12) * std::cbrt(model.inversion_threshold)) {
  const TissueCells& all = model.tissue_cells;
  if (all.size() == 0) return;
  of_slab_.resize(std::size_t(slabs.count()));
  // A run of cells whose first corners are in one slab goes to that slab.
  for (std::size_t begin = 0; begin < all.size();) {
    const int slab = slabs.of(all.corner[0][begin]);
    std::size_t end = begin + 1;
    while (end < all.size() && slabs.of(all.corner[0][end]) == slab) ++end;
    add_batches(of_slab_[std::size_t(slab)], begin, end);
    begin = end;
  }
  for (Slab& slab : of_slab_) add_rows(slab);
}

/// Adds cells [begin, end) in batches.
void CellCheck::add_batches(Slab& slab, std::size_t begin, std::size_t end) const {
  const auto& corner = model_.tissue_cells.corner;
  const auto follows = [&](std::size_t cell) {
    return std::all_of(corner.begin(), corner.end(), [&](const auto& of) { return of[cell] == of[cell - 1] + 1; });
  };
  slab.cells += end - begin;
  double volume = 0;
  for (std::size_t cell = begin; cell < end; ++cell) {
    const double own = rest_volume(model_, cell);
    const bool is_same = cell > begin && follows(cell) && are_alike(volume, own);
    if (is_same && slab.batches.back().cells.count < elements::kBatch) {
      ++slab.batches.back().cells.count;
      continue;
    }
    volume = own;
    Batch batch{{1, std::int32_t(cell), {}}, volume};
    for (std::size_t c = 0; c < 8; ++c) batch.cells.corner[c] = corner[c][cell];
    slab.batches.push_back(batch);
  }
}

/// Joins the edges of all batches that lie along the world's axes into rows, each edge once.
void CellCheck::add_rows(Slab& slab) const {
  slab.has_no_rows.resize(slab.batches.size()), slab.is_suspect.resize(slab.batches.size());
  std::vector<Edge> edges;
  for (std::size_t b = 0; b < slab.batches.size(); ++b) {
    const elements::CellBatch& cells = slab.batches[b].cells;
    for (std::int32_t i = 0; i < cells.count; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t e = 0; e < 4; ++e) {
          const auto [low, high] = corners_of(axis, e);
          const std::int32_t from = cells.corner[low] + i, to = cells.corner[high] + i;
          if (lies_along(edge_between(model_.rest_position, from, to), axis))
            edges.push_back({to - from, std::int32_t(axis), from, std::int32_t(b)});
          else
            slab.has_no_rows[b] = 1;
        }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Run> runs = join(edges);
  // In the order of their spheres, which then stay in the cache from row to row.
  std::stable_sort(runs.begin(), runs.end(), [](const Run& p, const Run& q) { return p.edges.a < q.edges.a; });
  for (const Run& run : runs) {
    double rest_length = 0;
    for (std::int32_t i = 0; i < run.edges.count; ++i)
      rest_length = std::max(rest_length, norm(edge_between(model_.rest_position, run.edges.a + i, run.edges.b + i)));
    slab.edges.push_back(run.edges);
    slab.rows.push_back({rest_length, std::int32_t(slab.user.size()), std::int32_t(run.users.size())});
    slab.user.insert(slab.user.end(), run.users.begin(), run.users.end());
  }
  slab.least.resize(runs.size());
}

/// Marks the batches whose edges do not show that every determinant is at least `limit`.
void CellCheck::find_suspects(Slab& slab, const elements::Points& points, double limit) const {
  slab.is_suspect = slab.has_no_rows;
  kernels_.least_of_edges(points, slab.edges.data(), slab.edges.data() + slab.edges.size(), slab.least.data());
  const double part = limit > 0 ? edge_threshold_ : 0;
  for (std::size_t r = 0; r < slab.rows.size(); ++r) {
    const Row& row = slab.rows[r];
    if (slab.least[r] > part * row.rest_length) continue;
    for (std::int32_t u = 0; u < row.users; ++u)
      slab.is_suspect[std::size_t(slab.user[std::size_t(row.first_user + u)])] = 1;
  }
}

}  // namespace ctpm::inversion
