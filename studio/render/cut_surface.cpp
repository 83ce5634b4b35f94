#include "studio/render/cut_surface.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "studio/render/cut_plane.h"
#include "studio/render/cut_vertices.h"
#include "studio/render/cut_wall.h"

namespace ctpm::render {
namespace {

using Index = CutVertices::Index;
using Triangle = std::array<Index, 3>;

constexpr double kPlaneReach = 2.4;    // in spacings: radius of the crossings that define the cut at a point
constexpr double kFarthestHome = 1.8;  // in spacings
constexpr double kRindEnds = 2.0;      // in layers: the middle of the second

}  // namespace

struct CutSurface::Parts {
  Parts(const Model& model, std::size_t organ, const Surface& uncut)
      : links(model, organ),
        is_layered(model.organs[organ].layer_count > 1),
        layer(std::span(model.layer).subspan(std::size_t(model.organs[organ].first))),
        whole(uncut),
        out(links) {
    bind_homes();
  }

  void bind_homes();
  void rebuild();
  void find_rind();

  Index home_on_own_side(std::size_t vertex);
  void add_whole_vertices();
  bool are_parted(Index u, Index v);
  Index middle(Index u, Index v);
  double where_parted(Index u, Index v);
  Index end_of_cut(Index a, Index b, Index c);
  void split_triangle(const Triangle& t);

  LatticeLinks links;
  const bool is_layered;
  std::span<const std::int32_t> layer;  ///< of the organ's spheres
  Surface whole;
  std::vector<Index> nearest;  ///< sphere to each vertex of `whole`
  CutVertices out;
  std::size_t outer_triangles = 0, outer_vertices = 0;
  std::vector<std::uint8_t> is_lip;
  std::vector<float> rind;

  // Scratch memory of rebuild().
  std::vector<std::uint8_t> is_near_cut;  ///< of the whole surface's vertices
  SplitLine split;
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
  out.surface() = whole;
  outer_triangles = whole.triangle.size(), outer_vertices = whole.vertex.size();
}

/// The nearest sphere that lies on the vertex's side of the cut.
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
    const std::optional<Plane> cut = fit_plane(out.crossings_around(s), rest, kPlaneReach * links.spacing());
    if (!cut || cut->height(rest) <= 0) return s;
  }
  return nearest[vertex];
}

/// Adds the whole surface's vertices; those near the cut are bound only to spheres that their home sees.
void CutSurface::Parts::add_whole_vertices() {
  const SurfaceBinding& b = whole.binding;
  is_near_cut.assign(whole.vertex.size(), 0);
  for (std::size_t v = 0; v < whole.vertex.size(); ++v) {
    const std::size_t first = std::size_t(b.first[v]), count = std::size_t(b.first[v + 1]) - first;
    const auto spheres = std::span(b.sphere).subspan(first, count);
    is_near_cut[v] = std::any_of(spheres.begin(), spheres.end(), [&](Index s) { return links.is_cut(s); });
    const Index home = is_near_cut[v] ? home_on_own_side(v) : nearest[v];
    if (is_near_cut[v] && std::any_of(spheres.begin(), spheres.end(), [&](Index s) { return out.loses(home, s); }))
      out.add(whole.vertex[v], home);
    else
      out.add(whole.vertex[v], home, spheres, std::span(b.weight).subspan(first, count));
  }
}

/// Whether the cut passes between two corners of a triangle.
bool CutSurface::Parts::are_parted(Index u, Index v) {
  const Index a = out.home(u), b = out.home(v);
  return is_near_cut[std::size_t(u)] && is_near_cut[std::size_t(v)] && out.loses(a, b);
}

/// The crossing of the edge u-v as a fraction in (0, 1).
double CutSurface::Parts::where_parted(Index u, Index v) {
  const Vec3 p = out.rest(u), q = out.rest(v);
  const double reach = kPlaneReach * links.spacing();
  const std::optional<Plane> cut = fit_plane(out.crossings_around(out.home(u)), 0.5 * (p + q), reach);
  if (!cut) return 0.5;
  const double at_u = cut->height(p), at_v = cut->height(q);
  return at_u == at_v ? 0.5 : std::clamp(at_u / (at_u - at_v), 0.03, 0.97);
}

/// The vertex on u's side where the cut splits the edge u-v.
Index CutSurface::Parts::middle(Index u, Index v) {
  const auto found = split.middles.find({u, v});
  if (found != split.middles.end()) return found->second;
  const Index low = std::min(u, v), high = std::max(u, v);
  const double t = where_parted(low, high);
  const Vec3 rest = (1 - t) * out.rest(low) + t * out.rest(high);
  split.middles[{low, high}] = out.add(rest, out.home(low));
  split.middles[{high, low}] = out.add(rest, out.home(high));
  return split.middles[{u, v}];
}

/// End of a cut that enters the triangle a b c between a and b: a point inside, where the blade stopped. The spheres
/// that c sees belong to both sides of the cut.
Index CutSurface::Parts::end_of_cut(Index a, Index b, Index c) {
  constexpr double kInto = 0.45, kInside = 0.03;  // towards c; least weight of a corner
  const Index low = std::min(a, b), high = std::max(a, b);
  double along = where_parted(low, high);
  if (low != a) along = 1 - along;
  const Vec3 pa = out.rest(a), pb = out.rest(b), pc = out.rest(c);
  double weight_a = (1 - kInto) * (1 - along), weight_b = (1 - kInto) * along;
  const Vec3 straight = weight_a * pa + weight_b * pb + kInto * pc;
  const std::optional<Plane> cut =
      fit_plane(out.crossings_around(out.home(a)), straight, kPlaneReach * links.spacing());
  if (cut && cut->height(pa) != cut->height(pb)) {
    const double shift = cut->height(straight) / (cut->height(pa) - cut->height(pb));
    const double kept = std::clamp(shift, std::min(0.0, kInside - weight_b), std::max(0.0, weight_a - kInside));
    weight_a -= kept, weight_b += kept;
  }
  return out.add(weight_a * pa + weight_b * pb + kInto * pc, out.home(c));
}

/// Emits the pieces of one triangle after the cut; they keep its orientation.
void CutSurface::Parts::split_triangle(const Triangle& t) {
  const auto emit = [&](Index a, Index b, Index c) { out.surface().triangle.push_back({a, b, c}); };
  if (!is_near_cut[std::size_t(t[0])] && !is_near_cut[std::size_t(t[1])] && !is_near_cut[std::size_t(t[2])])
    return emit(t[0], t[1], t[2]);
  const bool parted[3]{are_parted(t[0], t[1]), are_parted(t[1], t[2]), are_parted(t[2], t[0])};
  const int count = parted[0] + parted[1] + parted[2];
  if (count == 0) return emit(t[0], t[1], t[2]);
  if (count == 3) {
    // Three sides of cuts meet: each keeps its corner.
    const Vec3 centre = (out.rest(t[0]) + out.rest(t[1]) + out.rest(t[2])) / 3.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      const Index to_b = middle(a, b), to_c = middle(a, c), own = out.add(centre, out.home(a));
      emit(a, to_b, own), emit(a, own, to_c);
      split.lips.push_back({to_b, own}), split.lips.push_back({own, to_c});
    }
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Index a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    if (count == 1 && parted[i]) {
      const Index at_a = middle(a, b), at_b = middle(b, a), tip = end_of_cut(a, b, c);
      emit(a, at_a, tip), emit(at_b, b, tip), emit(b, c, tip), emit(c, a, tip);
      split.lips.push_back({at_a, tip}), split.lips.push_back({tip, at_b});
    }
    if (count == 2 && !parted[(i + 1) % 3]) {
      // a is alone on its side.
      const Index ab = middle(a, b), ac = middle(a, c), ba = middle(b, a), ca = middle(c, a);
      emit(a, ab, ac), emit(ba, b, c), emit(ba, c, ca);
      split.lips.push_back({ab, ac}), split.lips.push_back({ca, ba});
    }
  }
}

void CutSurface::Parts::find_rind() {
  const SurfaceBinding& b = out.surface().binding;
  rind.assign(out.surface().vertex.size(), 0.0f);
  if (!is_layered) return;
  for (std::size_t v = outer_vertices; v < rind.size(); ++v) {
    double at = 0;
    for (std::size_t e = std::size_t(b.first[v]); e < std::size_t(b.first[v + 1]); ++e)
      at += b.weight[e] * layer[std::size_t(b.sphere[e])];
    rind[v] = float(std::clamp((kRindEnds - at) / (kRindEnds - 1), 0.0, 1.0));
  }
}

void CutSurface::Parts::rebuild() {
  is_lip.clear(), rind.clear();
  if (!links.anything_cut()) {
    out.surface() = whole, outer_triangles = whole.triangle.size(), outer_vertices = whole.vertex.size();
    return;
  }
  out.clear(), split.lips.clear(), split.middles.clear();
  add_whole_vertices();
  for (const Triangle& t : whole.triangle) split_triangle(t);
  outer_triangles = out.surface().triangle.size(), outer_vertices = out.surface().vertex.size();
  is_lip.assign(outer_vertices, 0);
  for (const Lip& lip : split.lips) is_lip[std::size_t(lip.from)] = is_lip[std::size_t(lip.to)] = 1;
  add_cut_wall(out, split);
  find_rind();
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

const Surface& CutSurface::surface() const { return parts_->out.surface(); }
std::size_t CutSurface::outer_triangle_count() const { return parts_->outer_triangles; }
const std::vector<std::uint8_t>& CutSurface::is_lip() const { return parts_->is_lip; }
const std::vector<float>& CutSurface::rind() const { return parts_->rind; }
std::size_t CutSurface::outer_vertex_count() const { return parts_->outer_vertices; }

}  // namespace ctpm::render
