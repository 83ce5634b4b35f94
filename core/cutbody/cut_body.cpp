#include "core/cutbody/cut_body.h"

#include <algorithm>
#include <cmath>

#include "core/cutting/blade_geometry.h"
#include "core/surface/surface.h"

namespace ctpm::cutbody {
namespace {

/// Spheres are seen over this many of the grid's edges at most, and over one more than the shortest way: what can only
/// be reached around the end of a cut is on its other side.
constexpr std::int32_t kMostHops = 2 * CutGrid::kPerSpacing + 1, kDetour = 1;

/// Bindings whose weights are larger than this in sum would throw their vertex far out.
constexpr double kLargestSum = 4;

/// A binding must put its vertex in its place at rest within this part of a spacing.
constexpr double kOff = 1e-6;

/// Number of the grid's edges on the shortest way between two nodes.
std::int32_t hops_between(CutGrid::Node p, CutGrid::Node q) {
  std::int32_t up = 0, down = 0;
  for (std::size_t a = 0; a < 3; ++a) up = std::max(up, q[a] - p[a]), down = std::max(down, p[a] - q[a]);
  return up + down;
}

}  // namespace

CutBody::CutBody(const Model& model, std::size_t organ)
    : model_(model), organ_(model.organs[organ]), index_(organ), whole_(model.surfaces[organ]) {
  show_whole();
}

bool CutBody::update(const State& state) {
  if (!grid_) {
    if (cutting::swept_rows(state) == 0) return false;
    grid_.emplace(model_, index_);
    cut_box_ = {grid_->extent(), {-1, -1, -1}};
    visited_.assign(std::size_t(grid_->count()), 0);
  }
  if (!grid_->update(state)) return false;
  const CutGrid::NodeBox changed = grid_->take_changed();
  if (!grid_->anything_cut()) cut_box_ = {grid_->extent(), {-1, -1, -1}};
  for (std::size_t a = 0; a < 3; ++a)
    cut_box_.low[a] = std::min(cut_box_.low[a], changed.low[a]),
    cut_box_.high[a] = std::max(cut_box_.high[a], changed.high[a]);
  forget_near(changed);
  rebuild(state);
  return true;
}

/// Whether what a node sees may depend on crossings within a box.
bool CutBody::is_near(CutGrid::NodeBox box, Index node) const {
  const CutGrid::Node n = grid_->node(node);
  for (std::size_t a = 0; a < 3; ++a)
    if (n[a] < box.low[a] - kMostHops || n[a] > box.high[a] + kMostHops) return false;
  return true;
}

/// Forgets what is bound near edges that changed.
void CutBody::forget_near(CutGrid::NodeBox box) {
  std::erase_if(bound_, [&](const auto& entry) { return is_near(box, entry.first.side); });
  std::erase_if(seen_, [&](const auto& entry) { return is_near(box, entry.first); });
}

/// Spheres around a node far from any cut, ascending.
std::vector<CutBody::Index> CutBody::spheres_near(Index node) const {
  const CutGrid::Node n = grid_->node(node), e = grid_->extent();
  std::vector<Index> spheres;
  const auto from = [&](std::size_t a) { return std::max(0, n[a] - kMostHops); };
  const auto to = [&](std::size_t a) { return std::min(e[a] - 1, n[a] + kMostHops); };
  for (Index k = from(2); k <= to(2); ++k)
    for (Index j = from(1); j <= to(1); ++j) {
      const std::span<const Index> row = grid_->spheres_in_row(grid_->at({from(0), j, k}), grid_->at({to(0), j, k}));
      spheres.insert(spheres.end(), row.begin(), row.end());
    }
  std::sort(spheres.begin(), spheres.end());
  return spheres;
}

/// Spheres on the side of a node, ascending.
const std::vector<CutBody::Index>& CutBody::seen_from(Index node) {
  const auto [found, is_new] = seen_.try_emplace(node);
  std::vector<Index>& seen = found->second;
  if (!is_new) return seen;
  ++call_;
  const CutGrid::Node home = grid_->node(node);
  queue_.assign(1, {node, 0}), visited_[std::size_t(node)] = call_;
  for (std::size_t next = 0; next < queue_.size(); ++next) {
    const auto [at, hops] = queue_[next];
    const CutGrid::Node here = grid_->node(at);
    if (hops <= hops_between(home, here) + kDetour)
      for (const Index sphere : grid_->spheres_at(at)) seen.push_back(sphere);
    if (hops == kMostHops) continue;
    const auto go = [&](Index to) {
      if (visited_[std::size_t(to)] == call_ || !grid_->in_tissue(to)) return;
      visited_[std::size_t(to)] = call_, queue_.emplace_back(to, hops + 1);
    };
    for (int d = 1; d < CutGrid::kDirections; ++d) {
      const CutGrid::Node up{here[0] + (d & 1), here[1] + (d >> 1 & 1), here[2] + (d >> 2)},
          down{here[0] - (d & 1), here[1] - (d >> 1 & 1), here[2] - (d >> 2)};
      if (grid_->contains(up) && !grid_->is_parted(at, d)) go(grid_->at(up));
      if (grid_->contains(down) && !grid_->is_parted(grid_->at(down), d)) go(grid_->at(down));
    }
  }
  std::sort(seen.begin(), seen.end());
  return seen;
}

/// Follows the spheres of a list within reach; empty if they do not span space.
CutBody::Binding CutBody::follow(Vec3 rest, const std::vector<Index>& spheres, double reach) const {
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
std::vector<CutBody::Index> CutBody::spheres_around(Vec3 rest, double reach, Index piece) const {
  std::vector<Index> spheres;
  for (Index s = 0; s < organ_.count; ++s) {
    const Index node = grid_->node_of_sphere(s);
    if (piece >= 0 && (node < 0 || piece_[std::size_t(node)] != piece)) continue;
    if (norm(model_.rest_position[std::size_t(organ_.first + s)] - rest) < reach) spheres.push_back(s);
  }
  return spheres;
}

/// Where a place lies on the organ's own surface, if it does.
CutBody::Origin CutBody::origin_of(Vec3 rest) const {
  constexpr double kOnSurface = 2e-3;  // in spacings
  const Index triangle = grid_->nearest_triangle(rest);
  if (triangle < 0) return {-1, {}};
  const auto& t = whole_.triangle[std::size_t(triangle)];
  const Vec3 a = whole_.vertex[std::size_t(t[0])], b = whole_.vertex[std::size_t(t[1])],
             c = whole_.vertex[std::size_t(t[2])], p = cutting::nearest_in_triangle(rest, a, b, c);
  const Vec3 normal = cross(b - a, c - a);
  const double area2 = dot(normal, normal);
  if (norm(p - rest) > kOnSurface * organ_.spacing || !(area2 > 0)) return {-1, {}};
  const double of_b = dot(normal, cross(p - a, c - a)) / area2, of_c = dot(normal, cross(b - a, p - a)) / area2;
  return {triangle, {1 - of_b - of_c, of_b, of_c}};
}

/// Moves with the organ's own surface.
CutBody::Binding CutBody::follow_whole(const Origin& origin) const {
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

bool CutBody::is_own_side(const Binding& binding, Index side) {
  if (!is_near(cut_box_, side)) return true;
  const std::vector<Index>& seen = seen_from(side);
  return std::all_of(binding.sphere.begin(), binding.sphere.end(),
                     [&](Index s) { return std::binary_search(seen.begin(), seen.end(), s); });
}

CutBody::Bound CutBody::bind(const CutMesh::Vertex& vertex, bool is_outer) {
  Bound bound{vertex.rest, {}, {-1, {}}};
  if (is_outer) bound.origin = origin_of(vertex.rest);
  if (bound.origin.triangle >= 0) {
    bound.binding = follow_whole(bound.origin);
    bound.rest = {};
    const auto& t = whole_.triangle[std::size_t(bound.origin.triangle)];
    for (std::size_t i = 0; i < 3; ++i) bound.rest += bound.origin.weight[i] * whole_.vertex[std::size_t(t[i])];
    if (is_own_side(bound.binding, vertex.side)) return bound;
  }
  bound.binding = bind_to_own_side(bound.rest, vertex.side);
  return bound;
}

CutBody::Binding CutBody::bind_to_own_side(Vec3 rest, Index side) {
  const double reach = surface::kBindingReach * organ_.spacing;
  const std::vector<Index>& seen = seen_from(side);
  for (const double wider : {1.0, 1.5})
    if (Binding own = follow(rest, seen, wider * reach); !own.sphere.empty()) return own;
  if (piece_.empty()) piece_ = grid_->find_pieces();
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

void CutBody::show_whole() {
  surface_ = whole_, bound_.clear(), seen_.clear(), origin_.clear();
  outer_triangles_ = whole_.triangle.size(), outer_vertices_ = whole_.vertex.size();
}

void CutBody::rebuild(const State& state) {
  is_cut_ = grid_ && grid_->anything_cut();
  if (!is_cut_) return show_whole();
  CutMesh mesh = make_mesh(*grid_, state);
  // Vertices of the walls that also belong to the outer surface are doubled.
  std::vector<std::uint8_t> is_outer(mesh.vertex.size(), 0);
  for (std::size_t t = 0; t < mesh.outer_triangles; ++t)
    for (const Index v : mesh.triangle[t]) is_outer[std::size_t(v)] = 1;
  std::vector<Index> number(mesh.vertex.size(), -1), wall_number(mesh.vertex.size(), -1), source;
  const auto place = [&](Index v, std::vector<Index>& numbers) {
    if (numbers[std::size_t(v)] < 0) numbers[std::size_t(v)] = Index(source.size()), source.push_back(v);
    return numbers[std::size_t(v)];
  };
  outer_triangles_ = mesh.outer_triangles;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    if (t == mesh.outer_triangles) outer_vertices_ = source.size();
    for (Index& v : mesh.triangle[t]) v = place(v, t < mesh.outer_triangles ? number : wall_number);
  }
  if (mesh.triangle.size() == mesh.outer_triangles) outer_vertices_ = source.size();
  surface_ = {}, origin_.clear(), piece_.clear();
  surface_.triangle = std::move(mesh.triangle);
  surface_.binding.first.push_back(0);
  std::map<Key, Bound> bound;
  for (const Index v : source) {
    const CutMesh::Vertex& vertex = mesh.vertex[std::size_t(v)];
    const Key key{vertex.side, vertex.rest.x, vertex.rest.y, vertex.rest.z};
    auto found = bound.find(key);
    if (found == bound.end()) {
      auto known = bound_.extract(key);
      found = known.empty() ? bound.emplace(key, bind(vertex, is_outer[std::size_t(v)] != 0)).first
                            : bound.insert(std::move(known)).position;
    }
    const Binding& binding = found->second.binding;
    if (surface_.vertex.size() < outer_vertices_) origin_.push_back(found->second.origin);
    surface_.vertex.push_back(found->second.rest);
    surface_.binding.sphere.insert(surface_.binding.sphere.end(), binding.sphere.begin(), binding.sphere.end());
    surface_.binding.weight.insert(surface_.binding.weight.end(), binding.weight.begin(), binding.weight.end());
    surface_.binding.first.push_back(Index(surface_.binding.sphere.size()));
  }
  bound_ = std::move(bound);
}

}  // namespace ctpm::cutbody
