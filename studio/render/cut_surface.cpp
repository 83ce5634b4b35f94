#include "studio/render/cut_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/result.h"
#include "core/surface.h"
#include "studio/render/cut_plane.h"
#include "studio/render/lattice_links.h"
#include "studio/render/open_edges.h"

namespace ctpm {
namespace {

using Index = std::int32_t;
using Cell = LatticeLinks::Cell;
using Triangle = std::array<Index, 3>;

constexpr double kReachInSpacings = 2.2;  // as a whole surface is bound
constexpr std::size_t kFewestFollowed = 8;
constexpr int kSmoothings = 3;
constexpr double kPlaneReach = 2.4;    // in spacings: crossings that tell where the cut is at a place
constexpr double kFarthestHome = 1.8;  // in spacings

bool holds(const std::vector<Index>& sorted, Index value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

/// A corner of the wall: the middle of a cube of eight lattice cells, as many copies as the cut leaves pieces
/// there.
struct Corner {
  Vec3 rest;                    ///< where the blade passed [m]
  bool at_border = false;       ///< the cube reaches out of the organ
  bool is_snapped = false;      ///< lies on the split line of the outer surface
  std::vector<Index> spheres;   ///< that fill the cube's cells
  std::vector<Index> piece;     ///< of each of these; named by its first sphere
  std::map<Index, Index> copy;  ///< piece -> vertex of the wall
  std::vector<Cell> beside;     ///< corners that share a facet's side with this one
};

/// A side of the split line: an edge of the outer surface where the wall begins, as its outer triangle walks
/// it.
struct Lip {
  Index from, to;
};

}  // namespace

struct CutSurface::Parts {
  Parts(const Model& model, std::size_t organ, const Surface& uncut) : links(model, organ), whole(uncut) {
    bind_homes();
  }

  void bind_homes();
  void rebuild();

  const LatticeLinks::Sight& sight(Index home);
  const std::vector<CutPoint>& crossings_around(Index home);
  Index home_on_own_side(std::size_t vertex);
  Index add_vertex(Vec3 rest, Index home);
  Index copy_vertex(Index vertex);
  void follow(Vec3 rest, Index home);
  void add_whole_vertices();
  bool are_parted(Index u, Index v);
  Index middle(Index u, Index v);
  double where_parted(Index u, Index v);
  Index end_of_cut(Index a, Index b, Index c);
  void split_triangle(const Triangle& t);
  void find_corners();
  Corner make_corner(Cell cube) const;
  void smooth_corners();
  void add_facets();
  void add_skirt();
  Index on_wall(Index vertex);
  void close();
  void fill_loop(std::vector<Index> loop);
  double cost_of_edge(Index u, Index v);
  const Corner* nearest_corner(Vec3 rest, bool border_only) const;
  Index wall_copy(Corner& corner, Index piece);
  Index skirt_foot(Index lip_vertex);
  Index piece_seen_by(const Corner& corner, Index home);

  LatticeLinks links;
  Surface whole;
  std::vector<Index> nearest;  ///< sphere to each vertex of `whole`
  std::vector<Index> home;  ///< of each vertex of `out`, the nearest sphere on its side of the cut
  Surface out;
  std::size_t outer_triangles = 0, outer_vertices = 0;

  // Working memory of rebuild().
  std::map<Index, LatticeLinks::Sight> sights;
  std::map<Index, std::vector<CutPoint>> crossings;
  std::vector<std::uint8_t> is_near_cut;  ///< of the whole surface's vertices
  std::map<std::pair<Index, Index>, Index>
      middles;  ///< (u, v): the copy on u's side of the split of edge u-v
  std::vector<Lip> lips;
  std::vector<std::uint8_t> is_lip;
  std::map<Cell, Corner> corners;
  std::map<Index, Index> wall_vertex;  ///< of a vertex on a lip
};

void CutSurface::Parts::bind_homes() {
  const SurfaceBinding& b = whole.binding;
  for (std::size_t v = 0; v < whole.vertex.size(); ++v) {
    Index near = b.sphere[std::size_t(b.first[v])];
    for (Index e = b.first[v]; e < b.first[v + 1]; ++e) {
      const Index s = b.sphere[std::size_t(e)];
      if (norm(links.rest(s) - whole.vertex[v]) < norm(links.rest(near) - whole.vertex[v])) near = s;
    }
    nearest.push_back(near);
  }
  out = whole;
  outer_triangles = whole.triangle.size(), outer_vertices = whole.vertex.size();
}

const LatticeLinks::Sight& CutSurface::Parts::sight(Index sphere) {
  const auto found = sights.find(sphere);
  return found != sights.end() ? found->second
                               : sights.emplace(sphere, links.sight_from(sphere)).first->second;
}

const std::vector<CutPoint>& CutSurface::Parts::crossings_around(Index sphere) {
  const auto found = crossings.find(sphere);
  if (found != crossings.end()) return found->second;
  std::vector<CutPoint>& all = crossings[sphere];
  const LatticeLinks::Sight& at = sight(sphere);
  for (const Index s : at.seen)
    for (int step = 0; links.is_cut(s) && step < LatticeLinks::kSteps; ++step) {
      if (!links.is_severed(s, step) || !holds(at.lost, links.neighbour(s, step))) continue;
      const Vec3 way = links.rest(links.neighbour(s, step)) - links.rest(s);
      all.push_back({links.crossing(s, step), way / norm(way)});
    }
  return all;
}

/// The nearest sphere that has the vertex on its own side of where the blade passed.
Index CutSurface::Parts::home_on_own_side(std::size_t vertex) {
  const SurfaceBinding& b = whole.binding;
  const Vec3 rest = whole.vertex[vertex];
  std::vector<std::pair<double, Index>> near;
  for (Index e = b.first[vertex]; e < b.first[vertex + 1]; ++e) {
    const Index s = b.sphere[std::size_t(e)];
    near.emplace_back(norm(links.rest(s) - rest), s);
  }
  std::sort(near.begin(), near.end());
  for (const auto& [distance, s] : near) {
    if (distance > kFarthestHome * links.spacing()) break;
    const std::optional<Plane> cut = fit_plane(crossings_around(s), rest, kPlaneReach * links.spacing());
    if (!cut || cut->height(rest) <= 0) return s;
  }
  return nearest[vertex];
}

/// Appends a binding to what `home` sees around `rest`. Spheres that do not span space cannot hold a vertex
/// at its distance from them; then the reach grows until they do, or until nothing more is seen.
void CutSurface::Parts::follow(Vec3 rest, Index home_sphere) {
  constexpr double kWiden = 1.4, kHeld = 1e-6;  // kHeld: of a spacing
  std::vector<std::pair<double, Index>> near;
  for (const Index s : sight(home_sphere).seen) near.emplace_back(norm(links.rest(s) - rest), s);
  std::sort(near.begin(), near.end());
  const std::size_t least = std::min(near.size(), kFewestFollowed);
  std::vector<Vec3> centres;
  std::vector<double> weights;
  for (double reach = std::max(kReachInSpacings * links.spacing(), 1.05 * near[least - 1].first);;
       reach *= kWiden) {
    for (std::size_t i = centres.size(); i < near.size() && near[i].first < reach; ++i)
      centres.push_back(links.rest(near[i].second));
    weights = follow_weights(rest, centres, reach);
    Vec3 held = -rest;
    for (std::size_t i = 0; i < centres.size(); ++i) held += weights[i] * centres[i];
    if (norm(held) < kHeld * links.spacing() || reach > near.back().first) break;
  }
  for (std::size_t i = 0; i < centres.size(); ++i) out.binding.sphere.push_back(near[i].second);
  out.binding.weight.insert(out.binding.weight.end(), weights.begin(), weights.end());
  out.binding.first.push_back(Index(out.binding.sphere.size()));
}

Index CutSurface::Parts::add_vertex(Vec3 rest, Index home_sphere) {
  out.vertex.push_back(rest), home.push_back(home_sphere);
  follow(rest, home_sphere);
  return Index(out.vertex.size() - 1);
}

/// A second vertex at the same place that follows the same spheres.
Index CutSurface::Parts::copy_vertex(Index vertex) {
  SurfaceBinding& b = out.binding;
  const std::size_t begin = std::size_t(b.first[std::size_t(vertex)]),
                    end = std::size_t(b.first[std::size_t(vertex) + 1]);
  out.vertex.push_back(Vec3(out.vertex[std::size_t(vertex)])),
      home.push_back(Index(home[std::size_t(vertex)]));
  for (std::size_t e = begin; e < end; ++e)
    b.sphere.push_back(Index(b.sphere[e])), b.weight.push_back(double(b.weight[e]));
  b.first.push_back(Index(b.sphere.size()));
  return Index(out.vertex.size() - 1);
}

/// The whole surface's vertices; those near the cut follow only what their home sphere sees.
void CutSurface::Parts::add_whole_vertices() {
  const SurfaceBinding& b = whole.binding;
  is_near_cut.assign(whole.vertex.size(), 0);
  out.binding.first.push_back(0);
  for (std::size_t v = 0; v < whole.vertex.size(); ++v) {
    const auto begin = b.sphere.begin() + b.first[v], end = b.sphere.begin() + b.first[v + 1];
    is_near_cut[v] = std::any_of(begin, end, [&](Index s) { return links.is_cut(s); });
    bool sees_all = true;
    home[v] = nearest[v];
    if (is_near_cut[v]) {
      home[v] = home_on_own_side(v);
      const auto& lost = sight(home[v]).lost;
      sees_all = std::none_of(begin, end, [&](Index s) { return holds(lost, s); });
    }
    out.vertex.push_back(whole.vertex[v]);
    if (!sees_all) {
      follow(whole.vertex[v], home[v]);
      continue;
    }
    out.binding.sphere.insert(out.binding.sphere.end(), begin, end);
    out.binding.weight.insert(out.binding.weight.end(), b.weight.begin() + b.first[v],
                              b.weight.begin() + b.first[v + 1]);
    out.binding.first.push_back(Index(out.binding.sphere.size()));
  }
}

/// Whether the cut passes between two corners of a triangle.
bool CutSurface::Parts::are_parted(Index u, Index v) {
  const Index a = home[std::size_t(u)], b = home[std::size_t(v)];
  return a != b && is_near_cut[std::size_t(u)] && is_near_cut[std::size_t(v)] && holds(sight(a).lost, b);
}

/// How far along the edge u-v, in (0, 1), the blade passed.
double CutSurface::Parts::where_parted(Index u, Index v) {
  const Vec3 p = out.vertex[std::size_t(u)], q = out.vertex[std::size_t(v)];
  const double reach = kPlaneReach * links.spacing();
  const std::optional<Plane> cut = fit_plane(crossings_around(home[std::size_t(u)]), 0.5 * (p + q), reach);
  if (!cut) return 0.5;
  const double at_u = cut->height(p), at_v = cut->height(q);
  return at_u == at_v ? 0.5 : std::clamp(at_u / (at_u - at_v), 0.03, 0.97);
}

/// The vertex on u's side where the cut splits the edge u-v.
Index CutSurface::Parts::middle(Index u, Index v) {
  const auto found = middles.find({u, v});
  if (found != middles.end()) return found->second;
  const Index low = std::min(u, v), high = std::max(u, v);
  const double t = where_parted(low, high);
  const Vec3 rest = (1 - t) * out.vertex[std::size_t(low)] + t * out.vertex[std::size_t(high)];
  middles[{low, high}] = add_vertex(rest, home[std::size_t(low)]);
  middles[{high, low}] = add_vertex(rest, home[std::size_t(high)]);
  return middles[{u, v}];
}

/// Where a cut that enters the triangle a b c between a and b ends: inside, where the blade passed. What c sees
/// belongs to both banks.
Index CutSurface::Parts::end_of_cut(Index a, Index b, Index c) {
  constexpr double kInto = 0.45, kInside = 0.03;  // towards c; least weight of a corner
  const Index low = std::min(a, b), high = std::max(a, b);
  double along = where_parted(low, high);
  if (low != a) along = 1 - along;
  const Vec3 pa = out.vertex[std::size_t(a)], pb = out.vertex[std::size_t(b)], pc = out.vertex[std::size_t(c)];
  double weight_a = (1 - kInto) * (1 - along), weight_b = (1 - kInto) * along;
  const Vec3 straight = weight_a * pa + weight_b * pb + kInto * pc;
  const std::optional<Plane> cut =
      fit_plane(crossings_around(home[std::size_t(a)]), straight, kPlaneReach * links.spacing());
  if (cut && cut->height(pa) != cut->height(pb)) {
    const double shift = cut->height(straight) / (cut->height(pa) - cut->height(pb));
    const double kept = std::clamp(shift, std::min(0.0, kInside - weight_b), std::max(0.0, weight_a - kInside));
    weight_a -= kept, weight_b += kept;
  }
  return add_vertex(weight_a * pa + weight_b * pb + kInto * pc, home[std::size_t(c)]);
}

/// Emits what the cut leaves of one triangle; the pieces keep its orientation.
void CutSurface::Parts::split_triangle(const Triangle& t) {
  const auto emit = [&](Index a, Index b, Index c) { out.triangle.push_back({a, b, c}); };
  if (!is_near_cut[std::size_t(t[0])] && !is_near_cut[std::size_t(t[1])] && !is_near_cut[std::size_t(t[2])])
    return emit(t[0], t[1], t[2]);
  const bool parted[3]{are_parted(t[0], t[1]), are_parted(t[1], t[2]), are_parted(t[2], t[0])};
  const int count = parted[0] + parted[1] + parted[2];
  if (count == 0) return emit(t[0], t[1], t[2]);
  if (count == 3) {
    // Three banks meet: each keeps its corner.
    const Vec3 centre =
        (out.vertex[std::size_t(t[0])] + out.vertex[std::size_t(t[1])] + out.vertex[std::size_t(t[2])]) / 3.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      const Index to_b = middle(a, b), to_c = middle(a, c), own = add_vertex(centre, home[std::size_t(a)]);
      emit(a, to_b, own), emit(a, own, to_c);
      lips.push_back({to_b, own}), lips.push_back({own, to_c});
    }
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Index a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    if (count == 1 && parted[i]) {
      const Index at_a = middle(a, b), at_b = middle(b, a), tip = end_of_cut(a, b, c);
      emit(a, at_a, tip), emit(at_b, b, tip), emit(b, c, tip), emit(c, a, tip);
      lips.push_back({at_a, tip}), lips.push_back({tip, at_b});
    }
    if (count == 2 && !parted[(i + 1) % 3]) {
      // a is alone on its bank.
      const Index ab = middle(a, b), ac = middle(a, c), ba = middle(b, a), ca = middle(c, a);
      emit(a, ab, ac), emit(ba, b, c), emit(ba, c, ca);
      lips.push_back({ab, ac}), lips.push_back({ca, ba});
    }
  }
}

/// The eight cells around a dual corner: which spheres, in which pieces, and where the cut passes between
/// them.
Corner CutSurface::Parts::make_corner(Cell cube) const {
  Corner corner;
  for (Index n = 0; n < 8; ++n) {
    const Index s = links.at({cube[0] + (n & 1), cube[1] + (n >> 1 & 1), cube[2] + (n >> 2)});
    if (s < 0)
      corner.at_border = true;
    else
      corner.spheres.push_back(s), corner.piece.push_back(s);
  }
  int severed = 0;
  for (std::size_t i = 0; i < corner.spheres.size(); ++i)
    for (int s = 0; s < LatticeLinks::kSteps; ++s) {
      const auto other =
          std::find(corner.spheres.begin(), corner.spheres.end(), links.neighbour(corner.spheres[i], s));
      if (other == corner.spheres.end()) continue;
      if (links.is_severed(corner.spheres[i], s)) {
        corner.rest += links.crossing(corner.spheres[i], s), ++severed;
      } else if (links.is_joined(corner.spheres[i], s)) {
        const Index a = corner.piece[i], b = corner.piece[std::size_t(other - corner.spheres.begin())];
        std::replace(corner.piece.begin(), corner.piece.end(), std::max(a, b), std::min(a, b));
      }
    }
  corner.rest =
      severed ? corner.rest / double(severed) : links.place(cube[0] + 0.5, cube[1] + 0.5, cube[2] + 0.5);
  return corner;
}

/// The four corners around the middle of an axis link, counter-clockwise seen against the step's direction.
std::array<Cell, 4> corners_around(Cell cell, int axis) {
  const std::size_t p = std::size_t(axis + 1) % 3, q = std::size_t(axis + 2) % 3;
  std::array<Cell, 4> around{cell, cell, cell, cell};
  --around[0][p], --around[0][q], --around[1][q], --around[3][p];
  return around;
}

void CutSurface::Parts::find_corners() {
  for (Index a = 0; a < links.count(); ++a)
    for (int axis = 0; axis < 3; ++axis) {
      if (!links.is_cut(a) || !links.is_severed(a, 2 * axis)) continue;
      const auto around = corners_around(links.cell(a), axis);
      for (std::size_t i = 0; i < 4; ++i) {
        Corner& corner = corners.try_emplace(around[i]).first->second;
        if (corner.spheres.empty()) corner = make_corner(around[i]);
        corner.beside.push_back(around[(i + 1) % 4]), corner.beside.push_back(around[(i + 3) % 4]);
      }
    }
}

/// Border corners go onto the split line; the others become a smooth sheet.
void CutSurface::Parts::smooth_corners() {
  for (auto& [cube, corner] : corners) {
    if (!corner.at_border) continue;
    double nearest = 1.3 * links.spacing();
    for (const auto& [edge, vertex] : middles) {
      const double distance = norm(out.vertex[std::size_t(vertex)] - corner.rest);
      if (distance < nearest) nearest = distance, corner.is_snapped = true;
    }
    if (!corner.is_snapped) continue;
    Vec3 target = corner.rest;
    for (const auto& [edge, vertex] : middles)
      if (norm(out.vertex[std::size_t(vertex)] - corner.rest) == nearest)
        target = out.vertex[std::size_t(vertex)];
    corner.rest = target;
  }
  for (int round = 0; round < kSmoothings; ++round) {
    std::map<Cell, Vec3> smoothed;
    for (const auto& [cube, corner] : corners) {
      Vec3 mean;
      for (const Cell& other : corner.beside) mean += corners.at(other).rest / double(corner.beside.size());
      smoothed[cube] = corner.is_snapped ? corner.rest : 0.5 * (corner.rest + mean);
    }
    for (auto& [cube, corner] : corners) corner.rest = smoothed[cube];
  }
}

/// The wall's vertex for one piece at a corner.
Index CutSurface::Parts::wall_copy(Corner& corner, Index piece) {
  const auto found = corner.copy.find(piece);
  if (found != corner.copy.end()) return found->second;
  Index nearest = piece;
  for (std::size_t i = 0; i < corner.spheres.size(); ++i)
    if (corner.piece[i] == piece &&
        norm(links.rest(corner.spheres[i]) - corner.rest) < norm(links.rest(nearest) - corner.rest))
      nearest = corner.spheres[i];
  return corner.copy[piece] = add_vertex(corner.rest, nearest);
}

/// Each severed axis link has a dual facet, once for each bank, facing away from its own tissue.
void CutSurface::Parts::add_facets() {
  for (Index a = 0; a < links.count(); ++a)
    for (int axis = 0; axis < 3; ++axis) {
      if (!links.is_cut(a) || !links.is_severed(a, 2 * axis)) continue;
      const Index b = links.neighbour(a, 2 * axis);
      std::array<Index, 4> at_a{}, at_b{};
      const auto around = corners_around(links.cell(a), axis);
      for (std::size_t i = 0; i < 4; ++i) {
        Corner& corner = corners.at(around[i]);
        const auto piece_of = [&](Index sphere) {
          return corner.piece[std::size_t(std::find(corner.spheres.begin(), corner.spheres.end(), sphere) -
                                          corner.spheres.begin())];
        };
        at_a[i] = wall_copy(corner, piece_of(a)), at_b[i] = wall_copy(corner, piece_of(b));
      }
      if (at_a == at_b) continue;
      out.triangle.push_back({at_a[0], at_a[1], at_a[2]}),
          out.triangle.push_back({at_a[0], at_a[2], at_a[3]});
      out.triangle.push_back({at_b[0], at_b[2], at_b[1]}),
          out.triangle.push_back({at_b[0], at_b[3], at_b[2]});
    }
}

const Corner* CutSurface::Parts::nearest_corner(Vec3 rest, bool border_only) const {
  const Corner* nearest = nullptr;
  for (const auto& [cube, corner] : corners)
    if ((!border_only || corner.at_border) &&
        (!nearest || norm(corner.rest - rest) < norm(nearest->rest - rest)))
      nearest = &corner;
  return nearest;
}

/// The piece at a corner that a lip with this home belongs to: the one of which it sees most.
Index CutSurface::Parts::piece_seen_by(const Corner& corner, Index home_sphere) {
  std::map<Index, int> seen;
  for (std::size_t i = 0; i < corner.spheres.size(); ++i)
    seen[corner.piece[i]] += holds(sight(home_sphere).seen, corner.spheres[i]) ? 1 : 0;
  return std::max_element(seen.begin(), seen.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

/// The wall's vertex below a vertex of a lip; -1 if there is no wall nearby.
Index CutSurface::Parts::skirt_foot(Index lip_vertex) {
  const Vec3 rest = out.vertex[std::size_t(lip_vertex)];
  const Corner* corner = nearest_corner(rest, true);
  if (!corner || norm(corner->rest - rest) > 2.5 * links.spacing()) corner = nearest_corner(rest, false);
  if (!corner || norm(corner->rest - rest) > 2.5 * links.spacing()) return -1;
  return wall_copy(const_cast<Corner&>(*corner), piece_seen_by(*corner, home[std::size_t(lip_vertex)]));
}

/// Joins the lips to the wall.
void CutSurface::Parts::add_skirt() {
  std::map<Index, Index> foot;
  for (const Lip& lip : lips)
    for (const Index v : {lip.from, lip.to}) {
      if (wall_vertex.contains(v)) continue;
      foot[v] = skirt_foot(v);
      wall_vertex[v] = copy_vertex(v);
    }
  for (const Lip& lip : lips) {
    const Index from = wall_vertex[lip.from], to = wall_vertex[lip.to], foot_from = foot[lip.from],
                foot_to = foot[lip.to];
    if (foot_from < 0 || foot_to < 0) continue;
    out.triangle.push_back({to, from, foot_from});
    if (foot_from != foot_to) out.triangle.push_back({to, foot_from, foot_to});
  }
}

/// The wall's own vertex in place of one of a lip.
Index CutSurface::Parts::on_wall(Index vertex) {
  if (std::size_t(vertex) >= outer_vertices) return vertex;
  const auto found = wall_vertex.find(vertex);
  return found != wall_vertex.end() ? found->second : wall_vertex[vertex] = copy_vertex(vertex);
}

/// Length of an edge at rest, and much more if it would span the cut.
double CutSurface::Parts::cost_of_edge(Index u, Index v) {
  const Index a = home[std::size_t(u)], b = home[std::size_t(v)];
  const double across = a != b && holds(sight(a).lost, b) ? 10 * links.spacing() : 0.0;
  return across + norm(out.vertex[std::size_t(u)] - out.vertex[std::size_t(v)]);
}

/// Closes a loop of open edges with triangles, cutting off the cheapest corner first.
void CutSurface::Parts::fill_loop(std::vector<Index> loop) {
  while (loop.size() >= 3) {
    const std::size_t n = loop.size();
    std::size_t best = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < n && n > 3; ++i) {
      const double cost = cost_of_edge(loop[(i + n - 1) % n], loop[(i + 1) % n]);
      if (cost < least) least = cost, best = i;
    }
    const Index before = loop[(best + n - 1) % n], at = loop[best], after = loop[(best + 1) % n];
    out.triangle.push_back({after, at, before});
    if (n == 3) return;
    loop.erase(loop.begin() + std::ptrdiff_t(best));
  }
}

/// Fills whatever lips, wall and skirt leave open, so that every edge has its opposite: one never looks into the
/// organ. Where lips and wall fit each other, little is left.
void CutSurface::Parts::close() {
  OpenEdges open;
  for (const Lip& lip : lips) open.add(on_wall(lip.from), on_wall(lip.to));
  for (std::size_t t = outer_triangles; t < out.triangle.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) open.add(out.triangle[t][i], out.triangle[t][(i + 1) % 3]);
  for (const std::vector<Index>& loop : open.take_loops()) fill_loop(loop);
}

void CutSurface::Parts::rebuild() {
  home.assign(whole.vertex.size(), 0);
  is_lip.clear();
  if (!links.anything_cut()) {
    out = whole, outer_triangles = whole.triangle.size(), outer_vertices = whole.vertex.size();
    return;
  }
  out = {}, sights.clear(), crossings.clear(), middles.clear(), lips.clear(), corners.clear(), wall_vertex.clear();
  add_whole_vertices();
  for (const Triangle& t : whole.triangle) split_triangle(t);
  outer_triangles = out.triangle.size(), outer_vertices = out.vertex.size();
  is_lip.assign(outer_vertices, 0);
  for (const Lip& lip : lips) is_lip[std::size_t(lip.from)] = is_lip[std::size_t(lip.to)] = 1;
  find_corners();
  smooth_corners();
  add_facets();
  add_skirt();
  close();
}

CutSurface::CutSurface(const Model& model, std::size_t organ, const Surface& whole)
    : parts_(std::make_unique<Parts>(model, organ, whole)) {}
CutSurface::~CutSurface() = default;
CutSurface::CutSurface(CutSurface&&) noexcept = default;

bool CutSurface::update(const State& state) {
  if (!parts_->links.update(state)) return false;
  parts_->rebuild();
  return true;
}

const Surface& CutSurface::surface() const { return parts_->out; }
std::size_t CutSurface::outer_triangle_count() const { return parts_->outer_triangles; }
const std::vector<std::uint8_t>& CutSurface::is_lip() const { return parts_->is_lip; }
std::size_t CutSurface::outer_vertex_count() const { return parts_->outer_vertices; }

}  // namespace ctpm
