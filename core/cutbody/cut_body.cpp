#include "core/cutbody/cut_body.h"

#include <algorithm>

#include "core/cutbody/cut_grid.h"
#include "core/cutbody/cut_mesh.h"
#include "core/cutting/swept_surface.h"

namespace ctpm::cutbody {

using Triangle = std::array<CutGrid::Index, 3>;

struct CutBody::Parts {
  Parts(const Model& model, std::size_t organ) : grid(model, organ), binding(model, grid) {}

  CutGrid grid;
  SideBinding binding;
  /// Triangles of the whole organ between vertices of its own surface, by the grid's blocks: what there is far from a
  /// cut.
  std::vector<Index> first_far;
  std::vector<Triangle> far;
};

CutBody::CutBody(const Model& model, std::size_t organ) : model_(model), organ_(organ), whole_(model.surfaces[organ]) {
  show_whole();
}
CutBody::~CutBody() = default;
CutBody::CutBody(CutBody&&) noexcept = default;

/// The vertex of the organ's own surface that stands for those of the grid around it.
CutBody::Index CutBody::nearest_corner(Vec3 rest) const {
  const Index triangle = parts_->grid.nearest_triangle(rest);
  if (triangle < 0) return -1;
  const Triangle& t = whole_.triangle[std::size_t(triangle)];
  return *std::min_element(t.begin(), t.end(), [&](Index a, Index b) {
    const double to_a = norm(whole_.vertex[std::size_t(a)] - rest), to_b = norm(whole_.vertex[std::size_t(b)] - rest);
    return to_a < to_b || (to_a == to_b && a < b);
  });
}

void CutBody::prepare() {
  if (parts_) return;
  parts_ = std::make_unique<Parts>(model_, organ_);
  const CutMesh mesh = make_mesh(parts_->grid);
  std::vector<Index> corner;
  for (const CutMesh::Vertex& vertex : mesh.vertex) corner.push_back(nearest_corner(vertex.rest));
  const auto corners = [&](std::size_t t) {
    Triangle triangle;
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = corner[std::size_t(mesh.triangle[t][i])];
    return triangle;
  };
  const auto is_one = [](const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; };
  std::vector<Index>& first = parts_->first_far;
  first.assign(std::size_t(parts_->grid.block_count()) + 1, 0);
  for (std::size_t t = 0; t < mesh.outer_triangles; ++t)
    first[std::size_t(parts_->grid.block(mesh.cube[t])) + 1] += is_one(corners(t));
  for (std::size_t b = 0; b + 1 < first.size(); ++b) first[b + 1] += first[b];
  parts_->far.resize(std::size_t(first.back()));
  std::vector<Index> next(first.begin(), first.end() - 1);
  for (std::size_t t = 0; t < mesh.outer_triangles; ++t)
    if (const Triangle triangle = corners(t); is_one(triangle))
      parts_->far[std::size_t(next[std::size_t(parts_->grid.block(mesh.cube[t]))]++)] = triangle;
}

bool CutBody::update(const State& state) {
  if (!parts_ && cutting::swept_rows(state) == 0) return false;
  prepare();
  if (!parts_->grid.update(state)) return false;
  parts_->binding.forget_near(parts_->grid.take_changed());
  rebuild(state);
  return true;
}

std::int32_t CutBody::piece_count() const { return is_cut_ ? count_pieces(parts_->grid) : 1; }

void CutBody::show_whole() {
  surface_ = whole_, origin_.clear(), is_cut_ = false;
  outer_triangles_ = whole_.triangle.size(), outer_vertices_ = whole_.vertex.size();
}

void CutBody::add(const SideBinding::Bound& bound) {
  surface_.vertex.push_back(bound.rest);
  SurfaceBinding& to = surface_.binding;
  to.sphere.insert(to.sphere.end(), bound.binding.sphere.begin(), bound.binding.sphere.end());
  to.weight.insert(to.weight.end(), bound.binding.weight.begin(), bound.binding.weight.end());
  to.first.push_back(Index(to.sphere.size()));
}

void CutBody::rebuild(const State& state) {
  const CutGrid& grid = parts_->grid;
  if (!grid.anything_cut()) return show_whole();
  is_cut_ = true;
  const std::vector<std::uint8_t> near = grid.widened(grid.cut_blocks()), meshed = grid.widened(near);
  const CutMesh mesh = make_mesh(grid, meshed);
  const std::size_t count = mesh.vertex.size();
  std::vector<std::uint8_t> is_outer(count, 0), is_wall(count, 0);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const Index v : mesh.triangle[t]) (t < mesh.outer_triangles ? is_outer : is_wall)[std::size_t(v)] = 1;

  surface_ = {}, origin_.clear(), surface_.binding.first.push_back(0);
  // Far from the cut, vertices of the organ's own surface stand for those of the grid.
  std::vector<Index> of_corner(whole_.vertex.size(), -1), number(count, -1), wall_number(count, -1);
  const auto add_corner = [&](Index corner, Index side) {
    Index& known = of_corner[std::size_t(corner)];
    if (known >= 0) return known;
    known = Index(surface_.vertex.size());
    const SideBinding::Bound& bound =
        parts_->binding.bind({whole_.vertex[std::size_t(corner)], side}, true, false, state);
    add(bound), origin_.push_back(bound.origin);
    return known;
  };
  const auto add_outer = [&](Index v) {
    const CutMesh::Vertex& vertex = mesh.vertex[std::size_t(v)];
    if (number[std::size_t(v)] >= 0) return number[std::size_t(v)];
    if (!near[std::size_t(grid.block(vertex.side))])
      if (const Index corner = nearest_corner(vertex.rest); corner >= 0)
        return number[std::size_t(v)] = add_corner(corner, vertex.side);
    const SideBinding::Bound& bound = parts_->binding.bind(vertex, true, is_wall[std::size_t(v)] != 0, state);
    number[std::size_t(v)] = Index(surface_.vertex.size());
    add(bound), origin_.push_back(bound.origin);
    return number[std::size_t(v)];
  };
  const auto push = [&](Index a, Index b, Index c) {
    if (a != b && b != c && c != a) surface_.triangle.push_back({a, b, c});
  };
  for (std::size_t t = 0; t < mesh.outer_triangles; ++t) {
    const Triangle& v = mesh.triangle[t];
    const Index a = add_outer(v[0]), b = add_outer(v[1]), c = add_outer(v[2]);
    push(a, b, c);
  }
  for (Index b = 0; b < grid.block_count(); ++b) {
    if (meshed[std::size_t(b)]) continue;
    for (Index t = parts_->first_far[std::size_t(b)]; t < parts_->first_far[std::size_t(b) + 1]; ++t) {
      const Triangle& v = parts_->far[std::size_t(t)];
      const Index p = add_corner(v[0], -1), q = add_corner(v[1], -1), r = add_corner(v[2], -1);
      push(p, q, r);
    }
  }
  outer_triangles_ = surface_.triangle.size(), outer_vertices_ = surface_.vertex.size();
  for (std::size_t t = mesh.outer_triangles; t < mesh.triangle.size(); ++t) {
    Triangle corners = mesh.triangle[t];
    for (Index& v : corners) {
      Index& known = wall_number[std::size_t(v)];
      if (known < 0) {
        known = Index(surface_.vertex.size());
        add(parts_->binding.bind(mesh.vertex[std::size_t(v)], is_outer[std::size_t(v)] != 0, true, state));
      }
      v = known;
    }
    surface_.triangle.push_back(corners);
  }
}

}  // namespace ctpm::cutbody
