#include "core/cutbody/cut_body.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include "core/cutbody/cut_grid.h"
#include "core/cutbody/cut_mesh.h"
#include "core/cutbody/mesh_lists.h"
#include "core/cutbody/place_hash.h"
#include "core/cutting/swept_surface.h"

namespace ctpm::cutbody {

using Triangle = std::array<CutGrid::Index, 3>;

namespace {

/// Whether a blade went through an organ. It is asked in each tick, over all rows that there are.
bool is_swept(const State& state, std::size_t organ) {
  const std::vector<std::uint8_t>& swept = state.swept_organ;
  return !swept.empty() && std::memchr(swept.data(), int(organ + 1), swept.size()) != nullptr;
}

}  // namespace

struct CutBody::Parts {
  Parts(const Model& model, std::size_t organ) : grid(model, organ), mesher(grid), binding(model, grid) {}

  CutGrid grid;
  Mesher mesher;
  SideBinding binding;
  /// Triangles of the whole organ between vertices of its own surface, by the grid's blocks: what there is far from a
  /// cut.
  std::vector<Index> first_far;
  std::vector<Triangle> far;
  std::unordered_map<Vec3, Index, PlaceHash> nearest_corner;  ///< of places that were asked for
  std::vector<std::optional<SideBinding::Bound>> far_bound;   ///< of the organ's own vertices, where no cut is near
};

CutBody::CutBody(const Model& model, std::size_t organ) : model_(model), organ_(organ), whole_(model.surfaces[organ]) {
  show_whole();
}
CutBody::~CutBody() = default;
CutBody::CutBody(CutBody&&) noexcept = default;

/// The vertex of the organ's own surface that stands for those of the grid around it.
CutBody::Index CutBody::nearest_corner(Vec3 rest) const {
  const auto [found, is_new] = parts_->nearest_corner.try_emplace(rest, -1);
  const Index triangle = is_new ? parts_->grid.nearest_triangle(rest) : -1;
  if (triangle < 0) return found->second;
  const Triangle& t = whole_.triangle[std::size_t(triangle)];
  found->second = *std::min_element(t.begin(), t.end(), [&](Index a, Index b) {
    const double to_a = norm(whole_.vertex[std::size_t(a)] - rest), to_b = norm(whole_.vertex[std::size_t(b)] - rest);
    return to_a < to_b || (to_a == to_b && a < b);
  });
  return found->second;
}

void CutBody::prepare() {
  if (parts_) return;
  parts_ = std::make_unique<Parts>(model_, organ_);
  parts_->far_bound.resize(whole_.vertex.size());
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
  if (!parts_ && !is_swept(state, organ_)) return false;
  prepare();
  if (!parts_->grid.update(state)) return false;
  const CutGrid::NodeBox changed = parts_->grid.take_changed();
  parts_->mesher.update(changed), parts_->binding.update(changed);
  rebuild(state);
  return true;
}

std::int32_t CutBody::piece_count() const { return is_cut_ ? count_pieces(parts_->grid) : 1; }

std::vector<CutBody::Index> CutBody::piece_of_vertex() const {
  std::vector<Index> piece(surface_.vertex.size(), -1);
  if (!is_cut_) return piece;
  const std::vector<Index> of_node = parts_->grid.find_pieces();
  for (std::size_t v = 0; v < piece.size(); ++v)
    if (side_[v] >= 0) piece[v] = of_node[std::size_t(side_[v])];
  return piece;
}

void CutBody::show_whole() {
  surface_ = whole_, origin_.clear(), side_.clear(), is_cut_ = false;
  outer_triangles_ = whole_.triangle.size(), outer_vertices_ = whole_.vertex.size();
}

/// Makes surface_ anew: near the cut of the mesh of the grid, elsewhere of the organ's own vertices.
class CutBody::Rebuilding {
 public:
  Rebuilding(CutBody& body, const State& state)
      : body_(body),
        grid_(body.parts_->grid),
        state_(state),
        writer_(body.parts_->binding, body.surface_.binding),
        near_(grid_.widened(grid_.cut_blocks())),
        meshed_(grid_.widened(near_)),
        mesh_(body.parts_->mesher.make(meshed_)),
        of_corner_(body.whole_.vertex.size(), -1),
        outer_(mesh_.vertex.size(), -1),
        wall_(mesh_.vertex.size(), -1),
        is_outer_(mesh_.vertex.size(), 0),
        is_wall_(mesh_.vertex.size(), 0) {
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t)
      for (const Index v : mesh_.triangle[t]) (t < mesh_.outer_triangles ? is_outer_ : is_wall_)[std::size_t(v)] = 1;
    find_bubbles();
  }

  void add_outer() {
    for (std::size_t t = 0; t < mesh_.outer_triangles; ++t) {
      const Triangle& v = mesh_.triangle[t];
      const Index a = outer(v[0]), b = outer(v[1]), c = outer(v[2]);
      push(a, b, c);
    }
    for (Index block = 0; block < grid_.block_count(); ++block) {
      if (meshed_[std::size_t(block)]) continue;
      const std::vector<Index>& first = body_.parts_->first_far;
      for (Index t = first[std::size_t(block)]; t < first[std::size_t(block) + 1]; ++t) {
        const Triangle& v = body_.parts_->far[std::size_t(t)];
        const Index a = corner(v[0], -1), b = corner(v[1], -1), c = corner(v[2], -1);
        push(a, b, c);
      }
    }
  }

  void add_walls() {
    for (std::size_t t = mesh_.outer_triangles; t < mesh_.triangle.size(); ++t) {
      const Triangle& v = mesh_.triangle[t];
      if (is_bubble_[t - mesh_.outer_triangles] != 0) continue;
      const Index a = wall(v[0]), b = wall(v[1]), c = wall(v[2]);
      body_.surface_.triangle.push_back({a, b, c});
    }
  }

 private:
  /// Finds slits that are narrower than a spacing and reach no surface but in single points: the grid leaves them along
  /// the rim of a cut, where that crosses single edges only. Crumbs of tissue have such surfaces, too, but are pieces.
  void find_bubbles() {
    const std::size_t first = mesh_.outer_triangles, count = mesh_.triangle.size() - first;
    is_bubble_.assign(count, 0);
    DisjointSets joined;  // triangles of walls
    for (std::size_t t = 0; t < count; ++t) joined.add();
    std::vector<WallEdge> edges = edges_of_walls();
    std::vector<Index> open;  // triangles at edges that no other one has: walls that end at the surface
    for (std::size_t e = 0, next = 0; e < edges.size(); e = next) {
      while (next < edges.size() && edges[next].ends == edges[e].ends)
        joined.join(edges[e].triangle, edges[next++].triangle);
      if (next == e + 1) open.push_back(edges[e].triangle);
    }
    std::vector<std::uint8_t> is_open(count, 0);
    for (const Index t : open) is_open[std::size_t(joined.root(t))] = 1;
    std::map<Index, Box> inner;  // by their first triangles: walls that are closed by themselves
    for (std::size_t t = 0; t < count; ++t)
      if (const Index root = joined.root(Index(t)); is_open[std::size_t(root)] == 0)
        for (const Index v : mesh_.triangle[first + t]) {
          const Vec3 rest = mesh_.vertex[std::size_t(v)].rest;
          inner.try_emplace(root, rest).first->second.add(rest);
        }
    std::erase_if(inner, [&](const auto& part) {
      const Vec3 size = part.second.high - part.second.low;
      const double width =
          size.x + size.y + size.z - std::max({size.x, size.y, size.z}) - std::min({size.x, size.y, size.z});
      return width > CutGrid::kPerSpacing * grid_.step();
    });
    if (inner.empty()) return;
    const std::vector<Index> piece = grid_.find_pieces();
    const auto piece_of = [&](std::size_t t) {
      return piece[std::size_t(mesh_.vertex[std::size_t(mesh_.triangle[t][0])].side)];
    };
    std::set<Index> shown;  // pieces that have another surface
    for (std::size_t t = 0; t < mesh_.triangle.size(); ++t)
      if (t < first || !inner.contains(joined.root(Index(t - first)))) shown.insert(piece_of(t));
    std::erase_if(inner, [&](const auto& part) { return !shown.contains(piece_of(first + std::size_t(part.first))); });
    for (std::size_t t = 0; t < count; ++t) is_bubble_[t] = std::uint8_t(inner.contains(joined.root(Index(t))));
  }

  struct WallEdge {
    std::array<Index, 2> ends;  ///< vertices, ascending
    Index triangle;             ///< of the walls
    friend auto operator<=>(const WallEdge&, const WallEdge&) = default;
  };
  /// Ascending by their ends.
  std::vector<WallEdge> edges_of_walls() const {
    std::vector<WallEdge> edges;
    for (std::size_t t = mesh_.outer_triangles; t < mesh_.triangle.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const Index a = mesh_.triangle[t][c], b = mesh_.triangle[t][(c + 1) % 3];
        edges.push_back({{std::min(a, b), std::max(a, b)}, Index(t - mesh_.outer_triangles)});
      }
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  Index count() const { return Index(body_.surface_.vertex.size()); }
  void push(Index a, Index b, Index c) {
    if (a != b && b != c && c != a) body_.surface_.triangle.push_back({a, b, c});
  }
  const SideBinding::Bound& bound_of(const CutMesh::Vertex& vertex, bool is_wall) {
    return body_.parts_->binding.bind(vertex, true, is_wall, state_);
  }
  void add(const SideBinding::Bound& bound, Index side) {
    body_.surface_.vertex.push_back(bound.rest), body_.side_.push_back(side);
    writer_.add(bound.binding);
  }
  Index add_outer(const SideBinding::Bound& bound, Index side) {
    add(bound, side), body_.origin_.push_back(bound.origin);
    return count() - 1;
  }
  /// A vertex of the organ's own surface. Far from all cuts (side -1) it goes on as it is.
  Index corner(Index own, Index side) {
    Index& known = of_corner_[std::size_t(own)];
    if (known >= 0) return known;
    const CutMesh::Vertex vertex{body_.whole_.vertex[std::size_t(own)], side};
    if (side >= 0) return known = add_outer(bound_of(vertex, false), side);
    std::optional<SideBinding::Bound>& far = body_.parts_->far_bound[std::size_t(own)];
    if (!far) far = bound_of(vertex, false);
    return known = add_outer(*far, -1);
  }
  Index outer(Index v) {
    const CutMesh::Vertex& vertex = mesh_.vertex[std::size_t(v)];
    Index& known = outer_[std::size_t(v)];
    if (known >= 0) return known;
    const Index own = near_[std::size_t(grid_.block(vertex.side))] ? -1 : body_.nearest_corner(vertex.rest);
    return known = own >= 0 ? corner(own, vertex.side)
                            : add_outer(bound_of(vertex, is_wall_[std::size_t(v)] != 0), vertex.side);
  }
  Index wall(Index v) {
    Index& known = wall_[std::size_t(v)];
    if (known >= 0) return known;
    const CutMesh::Vertex& vertex = mesh_.vertex[std::size_t(v)];
    add(body_.parts_->binding.bind(vertex, is_outer_[std::size_t(v)] != 0, true, state_), vertex.side);
    return known = count() - 1;
  }

  CutBody& body_;
  const CutGrid& grid_;
  const State& state_;
  SideBinding::Writer writer_;
  std::vector<std::uint8_t> near_, meshed_;  ///< blocks around the cut, and around those
  CutMesh mesh_;
  std::vector<Index> of_corner_, outer_, wall_;   ///< vertices of surface_ made so far, or -1
  std::vector<std::uint8_t> is_outer_, is_wall_;  ///< vertices of the mesh
  std::vector<std::uint8_t> is_bubble_;           ///< triangles of its walls, see find_bubbles()
};

void CutBody::rebuild(const State& state) {
  if (!parts_->grid.anything_cut()) return show_whole();
  is_cut_ = true;
  // Emptied, so that their memory is used again.
  SurfaceBinding& binding = surface_.binding;
  surface_.vertex.clear(), surface_.triangle.clear(), origin_.clear(), side_.clear();
  binding.first.assign(1, 0), binding.sphere.clear(), binding.weight.clear(), binding.turned.clear();
  binding.frame.clear();
  Rebuilding rebuilding(*this, state);
  rebuilding.add_outer();
  outer_triangles_ = surface_.triangle.size(), outer_vertices_ = surface_.vertex.size();
  rebuilding.add_walls();
}

}  // namespace ctpm::cutbody
