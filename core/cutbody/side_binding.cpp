#include "core/cutbody/side_binding.h"

#include <algorithm>
#include <cmath>

#include "core/cutting/blade_geometry.h"
#include "core/surface/surface.h"

namespace ctpm::cutbody {
namespace {

/// Bindings whose weights are larger than this in sum would throw their vertex far out.
constexpr double kLargestSum = 4;

/// A binding must put its vertex in its place at rest within this part of a spacing.
constexpr double kOff = 1e-6;

/// Vertices this near to the organ's own surface are put onto it, in spacings.
constexpr double kOnSurface = 2e-3;

}  // namespace

SideBinding::SideBinding(const Model& model, const CutGrid& grid)
    : model_(model),
      organ_(model.organs[std::size_t(grid.organ())]),
      whole_(model.surfaces[std::size_t(grid.organ())]),
      grid_(grid),
      sight_(grid) {}

/// Whether what a node sees may depend on crossings within a box.
bool SideBinding::is_near(CutGrid::NodeBox box, Index node) const {
  const CutGrid::Node n = grid_.node(node);
  for (std::size_t a = 0; a < 3; ++a)
    if (n[a] < box.low[a] - Sight::kMostHops || n[a] > box.high[a] + Sight::kMostHops) return false;
  return true;
}

void SideBinding::forget_near(CutGrid::NodeBox changed) {
  // A cut far away may divide the piece that a vertex follows.
  std::erase_if(bound_, [&](const auto& entry) { return entry.second.by_piece || is_near(changed, entry.first.side); });
  std::erase_if(seen_, [&](const auto& entry) { return is_near(changed, entry.first); });
  piece_.clear(), row_boxes_.clear();
  sight_.update(changed);
}

const Sight::Seen& SideBinding::seen_from(Index node) {
  const auto [found, is_new] = seen_.try_emplace(node);
  if (is_new) found->second = sight_.from(node);
  return found->second;
}

/// Follows the spheres of a list within reach; empty if they do not span space.
SideBinding::Binding SideBinding::follow(Vec3 rest, const std::vector<Index>& spheres, double reach) const {
  Binding binding;
  std::vector<Vec3> centres;
  std::vector<double> trust;
  for (const Index s : spheres) {
    const auto sphere = std::size_t(organ_.first + s);
    if (norm(model_.rest_position[sphere] - rest) >= reach) continue;
    binding.sphere.push_back(s), centres.push_back(model_.rest_position[sphere]), trust.push_back(model_.mass[sphere]);
  }
  if (centres.size() < 4) return {};
  binding.weight = surface::follow_weights(rest, centres, trust, reach);
  Vec3 off = -rest;
  double sum = 0;
  for (std::size_t i = 0; i < centres.size(); ++i)
    off += binding.weight[i] * centres[i], sum += std::abs(binding.weight[i]);
  if (!(norm(off) < kOff * organ_.spacing) || !(sum < kLargestSum)) return {};
  return binding;
}

/// Spheres of a piece within reach; -1: of all pieces.
std::vector<SideBinding::Index> SideBinding::spheres_around(Vec3 rest, double reach, Index piece) const {
  std::vector<Index> spheres;
  for (Index s = 0; s < organ_.count; ++s) {
    const Index node = grid_.node_of_sphere(s);
    if (piece >= 0 && (node < 0 || piece_[std::size_t(node)] != piece)) continue;
    if (norm(model_.rest_position[std::size_t(organ_.first + s)] - rest) < reach) spheres.push_back(s);
  }
  return spheres;
}

SideBinding::Origin SideBinding::origin_of(Vec3 rest) const {
  const Index triangle = grid_.nearest_triangle(rest);
  if (triangle < 0) return {};
  const auto& t = whole_.triangle[std::size_t(triangle)];
  const Vec3 a = whole_.vertex[std::size_t(t[0])], b = whole_.vertex[std::size_t(t[1])],
             c = whole_.vertex[std::size_t(t[2])], p = cutting::nearest_in_triangle(rest, a, b, c);
  const Vec3 normal = cross(b - a, c - a);
  const double area2 = dot(normal, normal);
  if (!(area2 > 0)) return {};
  const double of_b = dot(normal, cross(p - a, c - a)) / area2, of_c = dot(normal, cross(b - a, p - a)) / area2;
  return {triangle, {1 - of_b - of_c, of_b, of_c}};
}

Vec3 SideBinding::place_of(const Origin& origin) const {
  Vec3 place;
  for (std::size_t i = 0; i < 3; ++i)
    place += origin.weight[i] * whole_.vertex[std::size_t(whole_.triangle[std::size_t(origin.triangle)][i])];
  return place;
}

/// Moves with the organ's own surface.
SideBinding::Binding SideBinding::follow_whole(const Origin& origin) const {
  std::map<Index, double> sum;
  const SurfaceBinding& whole = whole_.binding;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto v = std::size_t(whole_.triangle[std::size_t(origin.triangle)][i]);
    for (auto e = std::size_t(whole.first[v]); e < std::size_t(whole.first[v + 1]); ++e)
      sum[whole.sphere[e]] += origin.weight[i] * whole.weight[e];
  }
  Binding binding;
  for (const auto& [sphere, weight] : sum) binding.sphere.push_back(sphere), binding.weight.push_back(weight);
  return binding;
}

bool SideBinding::is_own_side(const Binding& binding, Index side) {
  if (side < 0) return true;
  const Sight::Seen& seen = seen_from(side);
  if (!seen.has_cut) return true;
  return std::all_of(binding.sphere.begin(), binding.sphere.end(),
                     [&](Index s) { return std::binary_search(seen.sphere.begin(), seen.sphere.end(), s); });
}

/// Takes a place of a wall back to the swept surface if it is off it, as beyond the end of a cut.
Vec3 SideBinding::near_cut(Vec3 rest, const State& state) {
  constexpr double kOffCut = 0.15, kReach = 1.5;  // in steps of the grid
  if (row_boxes_.size() + 1 != cutting::swept_rows(state)) row_boxes_ = cutting::boxes_of_rows(state);
  const auto nearest = [&](double steps) {
    return cutting::nearest_swept(state, row_boxes_, grid_.organ(), rest, steps * grid_.step());
  };
  // Most places are on it, which is found fast.
  if (nearest(kOffCut)) return rest;
  return nearest(kReach).value_or(rest);
}

const SideBinding::Bound& SideBinding::bind(const CutMesh::Vertex& vertex, bool is_outer, bool is_wall,
                                            const State& state) {
  const auto [found, is_new] =
      bound_.try_emplace({vertex.side, vertex.rest.x, vertex.rest.y, vertex.rest.z, is_outer, is_wall});
  Bound& bound = found->second;
  if (!is_new) return bound;
  bound.rest = is_wall ? near_cut(vertex.rest, state) : vertex.rest;
  if (is_outer) bound.origin = origin_of(bound.rest);
  if (bound.origin.triangle >= 0) {
    const Vec3 place = place_of(bound.origin);
    if (norm(place - bound.rest) <= kOnSurface * organ_.spacing) {
      bound.rest = place, bound.binding = follow_whole(bound.origin);
      if (is_own_side(bound.binding, vertex.side)) return bound;
    }
  }
  bound.binding = bind_to_own_side(bound.rest, vertex.side);
  bound.by_piece = bound.binding.sphere.empty();
  if (bound.by_piece) bound.binding = bind_to_piece(bound.rest, vertex.side);
  return bound;
}

/// Empty if the spheres of the vertex's side do not span space.
SideBinding::Binding SideBinding::bind_to_own_side(Vec3 rest, Index side) {
  const double reach = surface::kBindingReach * organ_.spacing;
  const std::vector<Index>& seen = seen_from(side).sphere;
  for (const double wider : {1.0, 1.5})
    if (Binding own = follow(rest, seen, wider * reach); !own.sphere.empty()) return own;
  return {};
}

SideBinding::Binding SideBinding::bind_to_piece(Vec3 rest, Index side) {
  const double reach = surface::kBindingReach * organ_.spacing;
  if (piece_.empty()) piece_ = grid_.find_pieces();
  for (const Index piece : {piece_[std::size_t(side)], Index(-1)}) {
    for (const double wider : {1.0, 1.5, 2.5, 4.0}) {
      const std::vector<Index> around = spheres_around(rest, wider * reach, piece);
      if (Binding any = follow(rest, around, wider * reach); !any.sphere.empty()) return any;
    }
    // Spheres in a plane, or fewer than four.
    const std::vector<Index> around = spheres_around(rest, 4 * reach, piece);
    if (around.empty()) continue;
    const auto distance = [&](Index s) { return norm(model_.rest_position[std::size_t(organ_.first + s)] - rest); };
    return {
        {*std::min_element(around.begin(), around.end(), [&](Index s, Index t) { return distance(s) < distance(t); })},
        {1.0}};
  }
  return {{0}, {1.0}};
}

}  // namespace ctpm::cutbody
