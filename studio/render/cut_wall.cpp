#include "studio/render/cut_wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "studio/render/open_edges.h"

namespace ctpm::render {
namespace {

using Index = CutVertices::Index;
using Cell = LatticeLinks::Cell;

constexpr int kSmoothings = 3;
constexpr double kFarthestFoot = 2.5;  // in spacings

/// A corner of the wall: the middle of a cube of eight lattice cells, with one copy for each piece that the cut leaves
/// there.
struct Corner {
  Vec3 rest;                    ///< on the cut [m]
  bool at_border = false;       ///< the cube extends out of the organ
  bool is_snapped = false;      ///< lies on the split line of the outer surface
  std::vector<Index> spheres;   ///< in the cube's cells
  std::vector<Index> piece;     ///< of each of these; named by its first sphere
  std::map<Index, Index> copy;  ///< piece -> vertex of the wall
  std::vector<Cell> beside;     ///< corners that share a facet's side with this one
};

class CutWall {
 public:
  CutWall(CutVertices& vertices, const SplitLine& split)
      : vertices_(vertices),
        links_(vertices.links()),
        split_(split),
        outer_vertices_(vertices.count()),
        outer_triangles_(vertices.surface().triangle.size()) {}

  void build() {
    find_corners();
    smooth_corners();
    add_facets();
    add_skirt();
    close();
  }

 private:
  Corner make_corner(Cell cube) const;
  bool is_wall(Index a, int axis) const;
  void find_corners();
  void smooth_corners();
  Index wall_copy(Corner& corner, Index piece);
  void add_facets();
  std::optional<Index> piece_seen_by(const Corner& corner, Index home);
  Index skirt_foot(Index lip_vertex);
  void add_skirt();
  Index on_wall(Index vertex);
  double cost_of_edge(Index u, Index v);
  void fill_loop(std::vector<Index> loop);
  void close();

  CutVertices& vertices_;
  const LatticeLinks& links_;
  const SplitLine& split_;
  const Index outer_vertices_;
  const std::size_t outer_triangles_;
  std::map<Cell, Corner> corners_;
  std::map<Index, Index> wall_vertex_;  ///< split-edge vertex of the outer surface -> its copy on the wall
};

/// The eight cells around a dual corner: their spheres, pieces, and crossings.
Corner CutWall::make_corner(Cell cube) const {
  Corner corner;
  for (Index n = 0; n < 8; ++n) {
    const Index s = links_.at({cube[0] + (n & 1), cube[1] + (n >> 1 & 1), cube[2] + (n >> 2)});
    if (s < 0 || !links_.is_inside(s))
      corner.at_border = true;
    else
      corner.spheres.push_back(s), corner.piece.push_back(s);
  }
  int severed = 0;
  for (std::size_t i = 0; i < corner.spheres.size(); ++i)
    for (int s = 0; s < LatticeLinks::kSteps; ++s) {
      const auto other =
          std::find(corner.spheres.begin(), corner.spheres.end(), links_.neighbour(corner.spheres[i], s));
      if (other == corner.spheres.end()) continue;
      if (links_.is_severed(corner.spheres[i], s)) {
        corner.rest += links_.crossing(corner.spheres[i], s), ++severed;
      } else if (links_.is_joined(corner.spheres[i], s)) {
        const Index a = corner.piece[i], b = corner.piece[std::size_t(other - corner.spheres.begin())];
        std::replace(corner.piece.begin(), corner.piece.end(), std::max(a, b), std::min(a, b));
      }
    }
  corner.rest = severed ? corner.rest / double(severed) : links_.place(cube[0] + 0.5, cube[1] + 0.5, cube[2] + 0.5);
  return corner;
}

/// The four corners around the middle of an axis link, counter-clockwise when seen against the step's direction.
std::array<Cell, 4> corners_around(Cell cell, int axis) {
  const std::size_t p = std::size_t(axis + 1) % 3, q = std::size_t(axis + 2) % 3;
  std::array<Cell, 4> around{cell, cell, cell, cell};
  --around[0][p], --around[0][q], --around[1][q], --around[3][p];
  return around;
}

/// Whether a wall crosses the link from sphere `a` along an axis.
bool CutWall::is_wall(Index a, int axis) const {
  return links_.is_cut(a) && links_.is_severed(a, 2 * axis) && links_.is_inside(a) &&
         links_.is_inside(links_.neighbour(a, 2 * axis));
}

void CutWall::find_corners() {
  for (Index a = 0; a < links_.count(); ++a)
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_wall(a, axis)) continue;
      const auto around = corners_around(links_.cell(a), axis);
      for (std::size_t i = 0; i < 4; ++i) {
        Corner& corner = corners_.try_emplace(around[i]).first->second;
        if (corner.spheres.empty()) corner = make_corner(around[i]);
        corner.beside.push_back(around[(i + 1) % 4]), corner.beside.push_back(around[(i + 3) % 4]);
      }
    }
}

/// Moves border corners onto the split line and smooths the others.
void CutWall::smooth_corners() {
  for (auto& [cube, corner] : corners_) {
    if (!corner.at_border) continue;
    double nearest = 1.3 * links_.spacing();
    for (const auto& [edge, vertex] : split_.middles) {
      const double distance = norm(vertices_.rest(vertex) - corner.rest);
      if (distance < nearest) nearest = distance, corner.is_snapped = true;
    }
    if (!corner.is_snapped) continue;
    Vec3 target = corner.rest;
    for (const auto& [edge, vertex] : split_.middles)
      if (norm(vertices_.rest(vertex) - corner.rest) == nearest) target = vertices_.rest(vertex);
    corner.rest = target;
  }
  for (int round = 0; round < kSmoothings; ++round) {
    std::map<Cell, Vec3> smoothed;
    for (const auto& [cube, corner] : corners_) {
      Vec3 mean;
      for (const Cell& other : corner.beside) mean += corners_.at(other).rest / double(corner.beside.size());
      smoothed[cube] = corner.is_snapped ? corner.rest : 0.5 * (corner.rest + mean);
    }
    for (auto& [cube, corner] : corners_) corner.rest = smoothed[cube];
  }
}

/// The wall's vertex for one piece at a corner.
Index CutWall::wall_copy(Corner& corner, Index piece) {
  const auto found = corner.copy.find(piece);
  if (found != corner.copy.end()) return found->second;
  Index nearest = piece;
  for (std::size_t i = 0; i < corner.spheres.size(); ++i)
    if (corner.piece[i] == piece &&
        norm(links_.rest(corner.spheres[i]) - corner.rest) < norm(links_.rest(nearest) - corner.rest))
      nearest = corner.spheres[i];
  return corner.copy[piece] = vertices_.add(corner.rest, nearest);
}

/// Adds the dual facet of each severed axis link, once for each cut face, facing away from its own tissue.
void CutWall::add_facets() {
  for (Index a = 0; a < links_.count(); ++a)
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_wall(a, axis)) continue;
      const Index b = links_.neighbour(a, 2 * axis);
      std::array<Index, 4> at_a{}, at_b{};
      const auto around = corners_around(links_.cell(a), axis);
      for (std::size_t i = 0; i < 4; ++i) {
        Corner& corner = corners_.at(around[i]);
        const auto piece_of = [&](Index sphere) {
          return corner.piece[std::size_t(std::find(corner.spheres.begin(), corner.spheres.end(), sphere) -
                                          corner.spheres.begin())];
        };
        at_a[i] = wall_copy(corner, piece_of(a)), at_b[i] = wall_copy(corner, piece_of(b));
      }
      if (at_a == at_b) continue;
      vertices_.surface().triangle.push_back({at_a[0], at_a[1], at_a[2]}),
          vertices_.surface().triangle.push_back({at_a[0], at_a[2], at_a[3]});
      vertices_.surface().triangle.push_back({at_b[0], at_b[2], at_b[1]}),
          vertices_.surface().triangle.push_back({at_b[0], at_b[3], at_b[2]});
    }
}

/// The piece at a corner to which a split edge with this home belongs: the one of which the home sees most spheres;
/// none if it sees none.
std::optional<Index> CutWall::piece_seen_by(const Corner& corner, Index home) {
  std::map<Index, int> seen;
  for (std::size_t i = 0; i < corner.spheres.size(); ++i)
    if (vertices_.sees(home, corner.spheres[i])) ++seen[corner.piece[i]];
  if (seen.empty()) return std::nullopt;
  return std::max_element(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

/// The wall's vertex below a vertex of a split edge, on the same side of the cut; -1 if there is no wall nearby.
Index CutWall::skirt_foot(Index lip_vertex) {
  const Vec3 rest = vertices_.rest(lip_vertex);
  const Index home = vertices_.home(lip_vertex);
  for (const bool border_only : {true, false}) {
    Corner* best = nullptr;
    double nearest = kFarthestFoot * links_.spacing();
    for (auto& [cube, corner] : corners_) {
      if (border_only && !corner.at_border) continue;
      const double distance = norm(corner.rest - rest);
      if (distance < nearest && piece_seen_by(corner, home)) nearest = distance, best = &corner;
    }
    if (best) return wall_copy(*best, *piece_seen_by(*best, home));
  }
  return -1;
}

/// Joins the split edges to the wall.
void CutWall::add_skirt() {
  std::map<Index, Index> foot;
  for (const Lip& lip : split_.lips)
    for (const Index v : {lip.from, lip.to}) {
      if (wall_vertex_.contains(v)) continue;
      foot[v] = skirt_foot(v);
      wall_vertex_[v] = vertices_.copy(v);
    }
  for (const Lip& lip : split_.lips) {
    const Index from = wall_vertex_[lip.from], to = wall_vertex_[lip.to], foot_from = foot[lip.from],
                foot_to = foot[lip.to];
    if (foot_from < 0 || foot_to < 0) continue;
    vertices_.surface().triangle.push_back({to, from, foot_from});
    if (foot_from != foot_to) vertices_.surface().triangle.push_back({to, foot_from, foot_to});
  }
}

/// The wall's own copy of a vertex of a split edge.
Index CutWall::on_wall(Index vertex) {
  if (vertex >= outer_vertices_) return vertex;
  const auto found = wall_vertex_.find(vertex);
  return found != wall_vertex_.end() ? found->second : wall_vertex_[vertex] = vertices_.copy(vertex);
}

/// Cost of an edge: its rest length, and much more if it spans the cut.
double CutWall::cost_of_edge(Index u, Index v) {
  const Index a = vertices_.home(u), b = vertices_.home(v);
  const double across = vertices_.loses(a, b) ? 10 * links_.spacing() : 0.0;
  return across + norm(vertices_.rest(u) - vertices_.rest(v));
}

/// Triangulates a loop of open edges, cheapest ear first.
void CutWall::fill_loop(std::vector<Index> loop) {
  while (loop.size() >= 3) {
    const std::size_t n = loop.size();
    std::size_t best = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < n && n > 3; ++i) {
      const double cost = cost_of_edge(loop[(i + n - 1) % n], loop[(i + 1) % n]);
      if (cost < least) least = cost, best = i;
    }
    const Index before = loop[(best + n - 1) % n], at = loop[best], after = loop[(best + 1) % n];
    vertices_.surface().triangle.push_back({after, at, before});
    if (n == 3) return;
    loop.erase(loop.begin() + std::ptrdiff_t(best));
  }
}

/// Fills the remaining open edges between split edges, wall and skirt, so that the surface is watertight. Where split
/// edges and wall fit each other, few remain.
void CutWall::close() {
  OpenEdges open;
  for (const Lip& lip : split_.lips) open.add(on_wall(lip.from), on_wall(lip.to));
  for (std::size_t t = outer_triangles_; t < vertices_.surface().triangle.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      open.add(vertices_.surface().triangle[t][i], vertices_.surface().triangle[t][(i + 1) % 3]);
  for (const std::vector<Index>& loop : open.take_loops()) fill_loop(loop);
}

}  // namespace

void add_cut_wall(CutVertices& vertices, const SplitLine& split) { CutWall(vertices, split).build(); }

}  // namespace ctpm::render
