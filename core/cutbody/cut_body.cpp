#include "core/cutbody/cut_body.h"

#include <algorithm>
#include <cmath>

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

std::vector<CutBody::Index> CutBody::spheres_around(Vec3 rest) const {
  std::vector<Index> spheres;
  for (Index s = 0; s < organ_.count; ++s)
    if (norm(model_.rest_position[std::size_t(organ_.first + s)] - rest) < 3 * organ_.spacing) spheres.push_back(s);
  return spheres;
}

CutBody::Binding CutBody::bind(Vec3 rest, Index side) {
  const double reach = surface::kBindingReach * organ_.spacing;
  for (const double wider : {1.0, 1.5}) {
    Binding own = is_near(cut_box_, side) ? follow(rest, seen_from(side), wider * reach)
                                          : follow(rest, spheres_near(side), reach);
    if (!own.sphere.empty()) return own;
  }
  const std::vector<Index> around = spheres_around(rest);
  for (const double wider : {1.0, 1.5}) {
    Binding any = follow(rest, around, wider * reach);
    if (!any.sphere.empty()) return any;
  }
  // A body of a few spheres in a plane.
  Index nearest = 0;
  const auto distance = [&](Index s) { return norm(model_.rest_position[std::size_t(organ_.first + s)] - rest); };
  for (Index s = 1; s < organ_.count; ++s)
    if (distance(s) < distance(nearest)) nearest = s;
  return {{nearest}, {1.0}};
}

void CutBody::show_whole() {
  surface_ = whole_, bound_.clear(), seen_.clear();
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
  surface_ = {};
  surface_.triangle = std::move(mesh.triangle);
  surface_.binding.first.push_back(0);
  std::map<Key, Binding> bound;
  for (const Index v : source) {
    const CutMesh::Vertex& vertex = mesh.vertex[std::size_t(v)];
    const Key key{vertex.side, vertex.rest.x, vertex.rest.y, vertex.rest.z};
    auto found = bound.find(key);
    if (found == bound.end()) {
      auto known = bound_.extract(key);
      found = known.empty() ? bound.emplace(key, bind(vertex.rest, vertex.side)).first
                            : bound.insert(std::move(known)).position;
    }
    const Binding& binding = found->second;
    surface_.vertex.push_back(vertex.rest);
    surface_.binding.sphere.insert(surface_.binding.sphere.end(), binding.sphere.begin(), binding.sphere.end());
    surface_.binding.weight.insert(surface_.binding.weight.end(), binding.weight.begin(), binding.weight.end());
    surface_.binding.first.push_back(Index(surface_.binding.sphere.size()));
  }
  bound_ = std::move(bound);
}

}  // namespace ctpm::cutbody
