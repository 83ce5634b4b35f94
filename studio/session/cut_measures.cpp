#include "studio/session/cut_measures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/cutting/cutting.h"

namespace ctpm::session {
namespace {

/// Parts of an edge of a swept quadrilateral into which its area is divided at the skin.
constexpr int kParts = 4;

/// Length of the line in a triangle along which the depth is 0.
double line_in_triangle(const std::array<Vec3, 3>& corner, const std::array<double, 3>& depth) {
  std::array<Vec3, 2> end;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if ((depth[i] > 0) == (depth[j] > 0)) continue;
    end[count++] = corner[i] + depth[i] / (depth[i] - depth[j]) * (corner[j] - corner[i]);
  }
  return count == 2 ? norm(end[1] - end[0]) : 0;
}

/// The places of those nodes from the tip to the heel that are `known`.
template <class IsKnown, class PlaceOf>
EdgePlaces edge_where(IsKnown&& is_known, PlaceOf&& place_of) {
  EdgePlaces edge;
  for (std::size_t n = cutting::kPointNodes; n < kEdgeNodes; ++n)
    if (is_known(n)) edge.place.push_back(place_of(n)), edge.from_tip = edge.from_tip || n == cutting::kPointNodes;
  return edge;
}

}  // namespace

CutMeasures::CutMeasures(const Model& model) : map_(model), depth_(model, map_), surfaces_(model.organs.size()) {
  for (std::size_t o = 0; o < std::min(surfaces_.size(), model.surfaces.size()); ++o)
    if (const Surface& s = model.surfaces[o]; !s.triangle.empty()) surfaces_[o].emplace(s.vertex, s.triangle);
}

void CutMeasures::add(const cutting::SweptQuad& quad, CutSize& size) const {
  const auto organ = std::size_t(quad.organ);
  if (!surfaces_[organ]) return;
  const std::array<Vec3, 4> corner{quad.from, quad.to, quad.from2, quad.to2};
  std::array<double, 4> depth;
  for (std::size_t i = 0; i < 4; ++i) {
    depth[i] = depth_.at(organ, corner[i]);
    if (depth[i] > 0)
      size.depth = std::max(size.depth, std::sqrt(surfaces_[organ]->nearest(corner[i]).squared_distance));
  }
  size.length += line_in_triangle({corner[0], corner[1], corner[2]}, {depth[0], depth[1], depth[2]}) +
                 line_in_triangle({corner[1], corner[3], corner[2]}, {depth[1], depth[3], depth[2]});
  double inside = 0;
  if (std::min({depth[0], depth[1], depth[2], depth[3]}) > 0)
    inside = 1;
  else if (std::max({depth[0], depth[1], depth[2], depth[3]}) > 0)
    for (int i = 0; i < kParts; ++i)
      for (int j = 0; j < kParts; ++j) {
        const double u = (i + 0.5) / kParts, v = (j + 0.5) / kParts;
        const double at = (1 - v) * ((1 - u) * depth[0] + u * depth[1]) + v * ((1 - u) * depth[2] + u * depth[3]);
        inside += at > 0 ? 1.0 / (kParts * kParts) : 0.0;
      }
  size.area += inside * 0.5 *
               (norm(cross(quad.to - quad.from, quad.from2 - quad.from)) +
                norm(cross(quad.to2 - quad.to, quad.from2 - quad.to)));
}

/// Of what the edge newly swept in a row.
double CutMeasures::along_blade(const State& state, std::size_t row, Vec3& way) const {
  const auto swept = [&](std::size_t node) { return state.swept_organ[row * kEdgeNodes + node]; };
  double deepest = 0;
  for (std::size_t organ = 0; organ < surfaces_.size(); ++organ) {
    if (!surfaces_[organ]) continue;
    const EdgePlaces edge =
        edge_where([&](std::size_t n) { return swept(n) == organ + 1 || swept(n - 1) == organ + 1; },
                   [&](std::size_t n) { return state.swept[row * kEdgeNodes + n]; });
    deepest = std::max(deepest, depth_along_blade(depth_, organ, edge, way));
  }
  return deepest;
}

double CutMeasures::edge_depth(const State& state) const {
  double deepest = 0;
  for (std::size_t organ = 0; organ < surfaces_.size() && !state.edge_organ.empty(); ++organ) {
    if (!surfaces_[organ]) continue;
    const EdgePlaces edge = edge_where([&](std::size_t n) { return state.edge_organ[n] == std::int32_t(organ); },
                                       [&](std::size_t n) { return state.blade_trail[n]; });
    Vec3 way;
    deepest = std::max(deepest, depth_along_blade(depth_, organ, edge, way));
  }
  return deepest;
}

void CutMeasures::measure(const State& state) {
  const std::size_t rows = cutting::swept_rows(state);
  const bool goes_on = rows > rows_ && (rows_ == 0 || state.swept[(rows_ - 1) * kEdgeNodes] == last_);
  if (!goes_on && rows != rows_) rows_ = 0, measured_ = {}, way_ = {}, any_ = false;
  const auto add_row = [&](std::size_t row, CutSize& size, Vec3& way) {
    bool any = false;
    for (std::size_t node = 0; row > 0 && node + 1 < kEdgeNodes; ++node)
      if (const cutting::SweptQuad quad = cutting::swept_quad(state, row, node); quad.organ >= 0)
        any = true, add(quad, size);
    if (any) size.along_blade = std::max(size.along_blade, along_blade(state, row, way));
    return any;
  };
  for (; rows_ + 1 < rows; ++rows_) any_ = add_row(rows_, measured_, way_) || any_;
  if (rows_ > 0) last_ = state.swept[(rows_ - 1) * kEdgeNodes];
  CutSize size = measured_;
  Vec3 way = way_;
  const bool any = (rows > rows_ && add_row(rows_, size, way)) || any_;
  const bool has_surface = std::any_of(surfaces_.begin(), surfaces_.end(), [](const auto& s) { return s.has_value(); });
  size_ = any && has_surface ? std::optional(size) : std::nullopt;
}

}  // namespace ctpm::session
