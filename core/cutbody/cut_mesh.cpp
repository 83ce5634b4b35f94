#include "core/cutbody/cut_mesh.h"

#include <algorithm>
#include <map>
#include <optional>

#include "core/cutbody/mesh_lists.h"

namespace ctpm::cutbody {
namespace {

using Index = CutGrid::Index;

/// Directions to the corners of the six tetrahedra of a cube, which share its diagonal.
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
/// Corners of the faces, seen from outside counter-clockwise if the tetrahedron's volume is positive.
constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

Vec3 unit(Vec3 v) {
  const double size = norm(v);
  return size > 0 ? v / size : Vec3{};
}

/// A point of the surface in a tetrahedron, on the simplex of `count` of its corners, whose nodes ascend. Each part of
/// the tissue that meets there has its own place for it: that of the swept surface which is nearest to the part.
struct Point {
  int corner[4];
  int count;
  bool operator==(const Point& other) const {
    return count == other.count && std::equal(corner, corner + count, other.corner);
  }
};

struct Plane {
  Vec3 point, normal;
};

/// The point that lies on planes as well as possible (least squares), and otherwise is near `start`: where two parts of
/// the swept surface meet, on the line between them (Ju et al., "Dual contouring of Hermite data", 2002).
Vec3 meeting_point(Vec3 start, const Plane* planes, int count) {
  constexpr double kStay = 1e-3;
  double a[3][3] = {{kStay, 0, 0}, {0, kStay, 0}, {0, 0, kStay}};
  Vec3 b;
  for (int i = 0; i < count; ++i) {
    const Vec3 n = unit(planes[i].normal);
    const double c[3] = {n.x, n.y, n.z};
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 3; ++k) a[r][k] += c[r] * c[k];
    b += dot(n, planes[i].point - start) * n;
  }
  const Vec3 u{a[0][0], a[1][0], a[2][0]}, v{a[0][1], a[1][1], a[2][1]}, w{a[0][2], a[1][2], a[2][2]};
  const double volume = dot(u, cross(v, w));
  return start + Vec3{dot(b, cross(v, w)), dot(u, cross(b, w)), dot(u, cross(v, b))} / volume;
}

}  // namespace

class Mesher::Parts {
 public:
  explicit Parts(const CutGrid& grid) : grid_(grid), vertices_(grid) {}

  void update(const CutGrid::NodeBox& changed);
  CutMesh run(CutGrid::Node low, CutGrid::Node high, const std::vector<std::uint8_t>& blocks);

 private:
  using Triangle = std::array<Index, 3>;

  /// A segment of the line in which the surface crosses a face: it parts node a from node b. From p to q, a triangle
  /// with an apex inside the tetrahedron faces a.
  struct Segment {
    Point p, q;
    int a_at_p, b_at_p, a_at_q, b_at_q;  ///< nodes on either side, at the segment's ends
  };

  bool is_parted(Index cube) const;
  void tetrahedron(Index cube, const int* corners);
  void find_labels();
  template <class... Corners>
  Point on(Corners... corners) const;
  Plane crossing(int a, int b) const;
  Vec3 place(const Point& point, int side) const;
  Vec3 on_surface(const Plane& surface, const Plane& cut) const;
  Vec3 place_on_face(const Point& face, int side) const;
  Vec3 place_within(int side) const;
  Vec3 kept_within(const Point& simplex, Vec3 from, Vec3 to) const;
  void join_where_the_cut_ends();
  void trace_face(const int* face);
  void close_simply();
  void close_from_the_middle();
  Index vertex(const Point& p, int side);
  struct Corner {
    const Point& point;
    int side;
  };
  void push(bool is_outer, Corner a, Corner b, Corner c);
  void join(const Point& point, int a, int b);
  void cube(Index at);
  CutMesh collect();

  const CutGrid& grid_;
  Vertices vertices_;
  Cubes now_, before_;
  CutGrid::NodeBox nothing() const { return {grid_.extent(), {-1, -1, -1}}; }
  std::vector<std::uint8_t> blocks_before_;  ///< empty: nothing is known of any
  CutGrid::NodeBox changed_ = nothing();     ///< since the last run

  // Of the present tetrahedron.
  Index node_[4];
  bool in_[4];    ///< tissue
  int label_[4];  ///< nodes of one label are joined; -1: outside
  bool parted_[4][4];
  int direction_[4][4];  ///< of the edge from the lower node to the other
  Segment segments_[12];
  int segment_count_ = 0;
  bool has_middle_ = false;  ///< three parts meet on a face
};

void Mesher::Parts::update(const CutGrid::NodeBox& changed) {
  if (changed.low == CutGrid::Node{} && changed.high == grid_.extent()) blocks_before_.clear();
  if (changed.low[0] <= changed.high[0]) changed_.add(changed.low), changed_.add(changed.high);
}

/// Of the cubes at nodes [low, high) of the grid.
CutMesh Mesher::Parts::run(CutGrid::Node low, CutGrid::Node high, const std::vector<std::uint8_t>& blocks) {
  for (std::size_t a = 0; a < 3; ++a) low[a] = std::max(low[a], 0), high[a] = std::min(high[a], grid_.extent()[a] - 1);
  std::swap(now_, before_), now_.clear(), vertices_.begin_round();
  if (blocks_before_.empty()) before_.clear(), vertices_.forget();
  std::size_t next = 0;
  for (Index k = low[2]; k < high[2]; ++k)
    for (Index j = low[1]; j < high[1]; ++j)
      for (Index i = low[0]; i < high[0]; ++i) {
        const Index at = grid_.at({i, j, k});
        const auto block = std::size_t(grid_.block(at));
        if (!blocks.empty() && blocks[block] == 0) {
          i |= CutGrid::kPerSpacing - 1;  // to the block's last
          continue;
        }
        const bool is_known =
            !blocks_before_.empty() && blocks_before_[block] != 0 && !grid_.touches(changed_, {i, j, k});
        if (!is_known) {
          cube(at);
          continue;
        }
        while (next < before_.cube.size() && before_.cube[next] < at) ++next;
        if (next < before_.cube.size() && before_.cube[next] == at) now_.copy(before_, next);
      }
  blocks_before_ = blocks, changed_ = nothing();
  return collect();
}

void Mesher::Parts::cube(Index at) {
  if (!is_parted(at)) return;
  for (const auto& corners : kTetrahedra) tetrahedron(at, corners);
  now_.close(at);
}

/// The vertices of joined sides are come across from the last to the first.
void Mesher::Parts::join(const Point& point, int a, int b) {
  const Index of_b = vertex(point, b);
  now_.joined.push_back({vertex(point, a), of_b});
}

/// As join().
void Mesher::Parts::push(bool is_outer, Corner a, Corner b, Corner c) {
  const Index third = vertex(c.point, c.side), second = vertex(b.point, b.side);
  (is_outer ? now_.outer : now_.wall).push_back({vertex(a.point, a.side), second, third});
}

/// Whether any edge of a cube's tetrahedra is parted.
bool Mesher::Parts::is_parted(Index cube) const {
  for (int from = 0; from < 7; ++from)
    for (int to = from + 1; to < 8; ++to)
      if ((from & to) == from && grid_.is_parted(grid_.end(cube, from), to ^ from)) return true;
  return false;
}

/// Nodes joined by whole edges share the label of the first of them.
void Mesher::Parts::find_labels() {
  for (int i = 0; i < 4; ++i) label_[i] = in_[i] ? i : -1;
  for (int round = 0; round < 3; ++round)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        if (i != j && in_[i] && in_[j] && !parted_[i][j]) label_[i] = label_[j] = std::min(label_[i], label_[j]);
}

template <class... Corners>
Point Mesher::Parts::on(Corners... corners) const {
  Point point{{corners...}, int(sizeof...(Corners))};
  std::sort(point.corner, point.corner + point.count, [&](int p, int q) { return node_[p] < node_[q]; });
  return point;
}

/// Where the surface crosses the edge between two corners, nearest to the first of them, which is in tissue. If the
/// second is outside, that is on the organ's surface, but not beyond a cut that crosses the edge too.
Plane Mesher::Parts::crossing(int a, int b) const {
  const bool a_is_lower = node_[a] < node_[b];
  const Index lower = std::min(node_[a], node_[b]), upper = std::max(node_[a], node_[b]);
  const int direction = a_is_lower ? direction_[a][b] : direction_[b][a];
  const Vec3 p = grid_.rest(lower), way = grid_.rest(upper) - p;
  const std::optional<CutGrid::Crossing> cut = grid_.cut_crossing(lower, direction, !a_is_lower);
  if (in_[b]) return {p + cut->along * way, cut->normal};
  const CutGrid::Crossing outer = grid_.outer_crossing(lower, direction);
  const Plane surface{p + outer.along * way, outer.normal};
  if (!cut || (cut->along < outer.along) != a_is_lower) return surface;
  return {on_surface(surface, {p + cut->along * way, cut->normal}), surface.normal};
}

/// From a place on the organ's surface along it to the cut, unless that is far.
Vec3 Mesher::Parts::on_surface(const Plane& surface, const Plane& cut) const {
  constexpr double kFar = 1.5;  // in steps of the grid
  const Plane planes[2] = {surface, cut};
  const Vec3 there = meeting_point(surface.point, planes, 2);
  return norm(there - surface.point) < kFar * grid_.step() ? there : surface.point;
}

Index Mesher::Parts::vertex(const Point& p, int side) {
  Index nodes[4]{};
  for (int i = 0; i < p.count; ++i) nodes[i] = node_[p.corner[i]];
  now_.vertex.push_back(vertices_.at(nodes, p.count, node_[side], [&] { return place(p, side); }));
  return now_.vertex.back();
}

Vec3 Mesher::Parts::place(const Point& p, int side) const {
  if (p.count == 2) return crossing(side, p.corner[p.corner[0] == side ? 1 : 0]).point;
  return p.count == 3 ? place_on_face(p, side) : place_within(side);
}

/// Goes from a place in a simplex towards another, as far as that is in it too.
Vec3 Mesher::Parts::kept_within(const Point& simplex, Vec3 from, Vec3 to) const {
  constexpr double kMargin = 0.02;
  const auto corner = [&](int i) { return grid_.rest(node_[simplex.corner[i]]); };
  double most = 1;
  for (int i = 0; i < simplex.count; ++i) {
    // Height over the side opposite of a corner.
    const Vec3 p = corner((i + 1) % simplex.count), q = corner((i + 2) % simplex.count), edge = q - p;
    Vec3 normal;
    if (simplex.count == 3)
      normal = corner(i) - p, normal = normal - dot(normal, edge) / dot(edge, edge) * edge;
    else
      normal = cross(edge, corner((i + 3) % 4) - p);
    const double whole = dot(normal, corner(i) - p), before = dot(normal, from - p) / whole,
                 after = dot(normal, to - p) / whole;
    if (after < kMargin && after < before) most = std::min(most, std::max(0.0, (before - kMargin) / (before - after)));
  }
  return from + most * (to - from);
}

/// Where three parts meet on a face. If one is outside, on the organ's surface, which the cut divides as it divides the
/// edge between the other two.
Vec3 Mesher::Parts::place_on_face(const Point& face, int side) const {
  const int other[2] = {face.corner[face.corner[0] == side ? 1 : 0], face.corner[face.corner[2] == side ? 1 : 2]};
  for (int i = 0; i < 2; ++i) {
    const int outside = other[i], q = other[1 - i];
    if (in_[outside]) continue;
    const Plane at_side = crossing(side, outside), at_q = crossing(q, outside), cut = crossing(side, q);
    const Vec3 between = at_q.point - at_side.point;
    const double across = dot(cut.normal, between);
    const double t = across != 0 ? std::clamp(dot(cut.normal, cut.point - at_side.point) / across, 0.0, 1.0) : 0.5;
    return on_surface({at_side.point + t * between, (1 - t) * unit(at_side.normal) + t * unit(at_q.normal)}, cut);
  }
  Plane planes[2] = {crossing(side, other[0]), crossing(side, other[1])};
  const Vec3 p = grid_.rest(node_[side]),
             normal = cross(grid_.rest(node_[other[0]]) - p, grid_.rest(node_[other[1]]) - p);
  for (Plane& plane : planes) plane.normal = plane.normal - dot(plane.normal, normal) / dot(normal, normal) * normal;
  const Vec3 start = 0.5 * (planes[0].point + planes[1].point);
  return kept_within(face, start, meeting_point(start, planes, 2));
}

/// Where the parts of a tetrahedron meet, for the part with the label `side`: on the organ's surface, if one is
/// outside.
Vec3 Mesher::Parts::place_within(int side) const {
  Vec3 at_surface, sum, to_outside;
  int of_surface = 0, count = 0, of_outside = 0;
  for (int i = 0; i < segment_count_; ++i) {
    const Segment& s = segments_[i];
    if (s.q.count != 3) continue;
    if (!in_[s.b_at_q] && label_[s.a_at_q] == side) at_surface += place(s.q, s.a_at_q), ++of_surface;
    if (!in_[s.a_at_q] && label_[s.b_at_q] == side) at_surface += place(s.q, s.b_at_q), ++of_surface;
  }
  if (of_surface > 0) return at_surface / double(of_surface);
  Plane planes[12];
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) {
      if (label_[a] != side || label_[b] == side || !parted_[a][b]) continue;
      const Plane at = crossing(a, b);
      if (in_[b])
        planes[count++] = at, sum += at.point;
      else
        to_outside += at.point, ++of_outside;
    }
  if (count == 0) return to_outside / double(of_outside);
  const Vec3 start = sum / double(count);
  return kept_within(on(0, 1, 2, 3), start, meeting_point(start, planes, count));
}

/// Sides that are joined within the tetrahedron share their vertices on its edges and faces.
void Mesher::Parts::join_where_the_cut_ends() {
  for (int a = 0; a < 4; ++a)
    for (int b = a + 1; b < 4; ++b) {
      if (!in_[a] || !in_[b] || label_[a] != label_[b] || !parted_[a][b]) continue;
      const Point edge = on(a, b);
      join(edge, a, b);
      for (int c = 0; c < 4; ++c) {
        if (c == a || c == b || !parted_[a][c] || !parted_[b][c]) continue;
        const Point face = on(a, b, c);
        join(face, a, b);
      }
    }
}

/// Finds the segments on a face whose corners run counter-clockwise seen from outside.
void Mesher::Parts::trace_face(const int* face) {
  const int parted = parted_[face[0]][face[1]] + parted_[face[1]][face[2]] + parted_[face[2]][face[0]];
  for (int i = 0; i < 3; ++i) {
    const int a = face[i], b = face[(i + 1) % 3], c = face[(i + 2) % 3];
    if (parted == 3 && label_[a] != label_[b])
      segments_[segment_count_++] = {on(a, b), on(a, b, c), a, b, a, b}, has_middle_ = true;
    if (parted == 2 && !parted_[b][c] && label_[a] != label_[b])
      segments_[segment_count_++] = {on(a, b), on(a, c), a, b, a, c};
  }
}

/// Two parts whose border crosses only edges: a triangle or a quadrilateral, once for each part.
void Mesher::Parts::close_simply() {
  // All segments from the same part's side.
  const int label = label_[segments_[0].a_at_p];
  for (int i = 0; i < segment_count_; ++i) {
    Segment& s = segments_[i];
    if (label_[s.a_at_p] != label) s = {s.q, s.p, s.b_at_q, s.a_at_q, s.b_at_p, s.a_at_p};
  }
  for (int i = 0; i + 1 < segment_count_; ++i)
    for (int j = i + 1; j < segment_count_; ++j)
      if (segments_[j].p == segments_[i].q) {
        std::swap(segments_[i + 1], segments_[j]);
        break;
      }
  const bool in_a = in_[segments_[0].a_at_p], in_b = in_[segments_[0].b_at_p];
  for (int i = 1; i + 1 < segment_count_; ++i) {
    const Segment &s = segments_[0], &t = segments_[i], &u = segments_[i + 1];
    if (in_a) push(!in_b, {u.p, u.a_at_p}, {t.p, t.a_at_p}, {s.p, s.a_at_p});
    if (in_b) push(!in_a, {s.p, s.b_at_p}, {t.p, t.b_at_p}, {u.p, u.b_at_p});
  }
}

/// Any number of parts: triangles from their borders on the faces to a point in the middle.
void Mesher::Parts::close_from_the_middle() {
  const Point apex = on(0, 1, 2, 3);
  for (int i = 0; i < segment_count_; ++i) {
    const Segment& s = segments_[i];
    const int a = label_[s.a_at_p], b = label_[s.b_at_p];
    if (a >= 0) push(b < 0, {s.q, s.a_at_q}, {s.p, s.a_at_p}, {apex, a});
    if (b >= 0) push(a < 0, {s.p, s.b_at_p}, {s.q, s.b_at_q}, {apex, b});
  }
}

void Mesher::Parts::tetrahedron(Index cube, const int* corners) {
  bool any = false;
  for (int i = 0; i < 4; ++i) node_[i] = grid_.end(cube, corners[i]), in_[i] = grid_.in_tissue(node_[i]);
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) {
      if (node_[a] >= node_[b]) continue;
      direction_[a][b] = corners[b] ^ corners[a];
      parted_[a][b] = parted_[b][a] = grid_.is_parted(node_[a], direction_[a][b]);
      any = any || parted_[a][b];
    }
  if (!any) return;
  find_labels();
  join_where_the_cut_ends();
  segment_count_ = 0, has_middle_ = false;
  for (const auto& face : kFaces) trace_face(face);
  if (segment_count_ == 0) return;
  int parts = 0;
  for (int i = 0; i < 4; ++i) {
    bool is_first = true;
    for (int j = 0; j < i; ++j) is_first = is_first && label_[j] != label_[i];
    parts += is_first;
  }
  if (parts == 2 && !has_middle_)
    close_simply();
  else
    close_from_the_middle();
}

/// Numbers the vertices, leaves out walls whose two sides are one, and puts the outer triangles first.
CutMesh Mesher::Parts::collect() {
  std::vector<Index> place(vertices_.count(), -1), at_place;  // in the order in which they were come across
  DisjointSets joined;
  for (const Index v : now_.vertex)
    if (place[std::size_t(v)] < 0) place[std::size_t(v)] = joined.add(), at_place.push_back(v);
  for (const auto& [a, b] : now_.joined) joined.join(place[std::size_t(a)], place[std::size_t(b)]);
  const auto roots = [&](Triangle t) {
    for (Index& v : t) v = joined.root(place[std::size_t(v)]);
    return t;
  };
  const auto sorted = [&](Triangle t) {
    t = roots(t);
    std::sort(t.begin(), t.end());
    return t;
  };
  std::map<Triangle, int> copies;
  for (const Triangle& t : now_.wall) ++copies[sorted(t)];
  CutMesh mesh;
  std::vector<Index> number(at_place.size(), -1);
  const auto add = [&](Index cube, Triangle t) {
    t = roots(t);
    for (Index& v : t) {
      Index& n = number[std::size_t(v)];
      if (n < 0) n = Index(mesh.vertex.size()), mesh.vertex.push_back(vertices_[at_place[std::size_t(v)]]);
      v = n;
    }
    mesh.triangle.push_back(t), mesh.cube.push_back(cube);
  };
  std::size_t next = 0;
  for (std::size_t c = 0; c < now_.cube.size(); ++c)
    for (; next < now_.end[c].outer; ++next) add(now_.cube[c], now_.outer[next]);
  mesh.outer_triangles = mesh.triangle.size(), next = 0;
  for (std::size_t c = 0; c < now_.cube.size(); ++c)
    for (; next < now_.end[c].wall; ++next)
      if (copies[sorted(now_.wall[next])] == 1) add(now_.cube[c], now_.wall[next]);
  return mesh;
}

Mesher::Mesher(const CutGrid& grid) : parts_(std::make_unique<Parts>(grid)), grid_(grid) {}
Mesher::~Mesher() = default;

void Mesher::update(const CutGrid::NodeBox& changed) { parts_->update(changed); }

CutMesh Mesher::make(const std::vector<std::uint8_t>& blocks) { return parts_->run({0, 0, 0}, grid_.extent(), blocks); }

CutMesh make_mesh(const CutGrid& grid) { return Mesher(grid).make({}); }

CutMesh make_mesh_around(const CutGrid& grid, CutGrid::Index block) {
  CutGrid::Node low = grid.first_node(block), high = low;
  for (std::size_t a = 0; a < 3; ++a) low[a] -= 1, high[a] += CutGrid::kPerSpacing + 1;
  return Mesher::Parts(grid).run(low, high, {});
}

std::int32_t count_pieces(const CutGrid& grid) {
  const std::vector<Index> pieces = grid.find_pieces();
  std::int32_t count = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) count += pieces[i] == Index(i);
  return count;
}

}  // namespace ctpm::cutbody
