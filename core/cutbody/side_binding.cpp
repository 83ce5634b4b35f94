#include "core/cutbody/side_binding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/cutbody/place_hash.h"
#include "core/cutting/blade_geometry.h"
#include "core/surface/surface.h"

namespace ctpm::cutbody {
namespace {

/// Spheres on one side of a place throw it far out where their weights are large in sum: up to the first sum a way to
/// follow them counts in full, from the second on not at all (our choice). Beside a cut, near spheres are soon left for
/// those in a wider reach, which throw it less; spheres of its own side are followed as far as that is sensible.
struct Sums {
  double all, none;
};
constexpr Sums kNear{1.3, 2.5}, kFar{2, 4};
constexpr double kWider = 1.5;

/// The same for spheres that hardly leave a plane: a single one far beside it would throw a place out and in. In
/// spacings squared; those of half a space have some 0.1.
constexpr double kFlat = 0.02, kDeep = 0.06;

/// A binding must put its vertex in its place at rest within this part of a spacing.
constexpr double kOff = 1e-6;

/// Vertices this near to the organ's own surface are put onto it, in spacings.
constexpr double kOnSurface = 2e-3;

/// Places this near to the swept surface are put onto it; a place's node is so near to it. In steps of the grid.
constexpr double kOntoCut = 1.5, kSideSteps = 1.7321;

/// A place follows the frames of its own spheres wholly where they count for so much in sum (our choice); one that is
/// half of the reach away counts 0.56. With less, the surface of a thin strip is stretched where it goes from the
/// spheres within reach over to those nearest along the strip: from 0.3 to 1.5 the triangles that strokes stretched
/// more than six times fell from 473 to 68 in a liver's strip of half a spacing.
constexpr double kEnough = 1.5;

/// How far the spheres are that tell how the tissue around one turns: no farther than elements reach, so that a sharp
/// bend turns few of them. In spacings.
constexpr double kOfFrame = 1.6;

/// From 0 to 1 where `t` does.
double smooth(double t) {
  const double q = std::clamp(t, 0.0, 1.0);
  return q * q * (3 - 2 * q);
}

/// Sums by spheres, ascending. Each is added up in the order of the calls.
template <class Value>
struct SumBySphere {
  std::vector<CutGrid::Index> sphere;
  std::vector<Value> sum;

  void add(CutGrid::Index of, Value value) {
    const auto at = std::lower_bound(sphere.begin(), sphere.end(), of);
    const auto number = std::size_t(at - sphere.begin());
    if (at == sphere.end() || *at != of)
      sphere.insert(at, of), sum.insert(sum.begin() + std::ptrdiff_t(number), Value{});
    sum[number] += value;
  }
};

/// Harmonic sum of the three principal variances of points [m^2]: at most the least of them, and at least a third of
/// it. `weight`: of each.
double least_variance(std::span<const Vec3> points, std::span<const double> weight) {
  double sum = 0, xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;
  Vec3 mean;
  for (std::size_t i = 0; i < points.size(); ++i) sum += weight[i], mean += weight[i] * points[i];
  if (!(sum > 0)) return 0;
  mean = mean / sum;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 d = points[i] - mean;
    const double w = weight[i] / sum;
    xx += w * d.x * d.x, yy += w * d.y * d.y, zz += w * d.z * d.z;
    xy += w * d.x * d.y, yz += w * d.y * d.z, zx += w * d.z * d.x;
  }
  const double minors = xx * yy - xy * xy + yy * zz - yz * yz + zz * xx - zx * zx;
  const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx);
  return minors > 0 ? std::max(0.0, determinant / minors) : 0.0;
}

}  // namespace

/// Several ways to follow spheres, the first ones as far as their weights are small: so that neighbouring places change
/// from one way to the next smoothly.
class SideBinding::Mix {
 public:
  bool is_whole() const { return missing_ == 0; }

  /// Adds as much of a way as its weights allow. An empty one is no way.
  void add(const Binding& way, Sums sums) {
    if (way.sphere.empty()) return;
    double sum = 0;
    for (const double w : way.weight) sum += std::abs(w);
    add(way, smooth((sums.none - sum) / (sums.none - sums.all)) * smooth((way.depth - kFlat) / (kDeep - kFlat)));
  }

  /// Adds a part of a way.
  void add(const Binding& way, double part) {
    if (part == 0) return;
    for (std::size_t i = 0; i < way.sphere.size(); ++i) weight_.add(way.sphere[i], missing_ * part * way.weight[i]);
    for (const Binding::Turned& turned : way.turned) offset_.add(turned.sphere, missing_ * part * turned.offset);
    missing_ *= 1 - part;
  }

  Binding binding() && {
    Binding all{std::move(weight_.sphere), std::move(weight_.sum), 0, {}};
    for (std::size_t i = 0; i < offset_.sphere.size(); ++i) all.turned.push_back({offset_.sphere[i], offset_.sum[i]});
    return all;
  }

 private:
  SumBySphere<double> weight_;
  SumBySphere<Vec3> offset_;
  double missing_ = 1;
};

void SideBinding::Writer::add(const Binding& binding) {
  to_.sphere.insert(to_.sphere.end(), binding.sphere.begin(), binding.sphere.end());
  to_.weight.insert(to_.weight.end(), binding.weight.begin(), binding.weight.end());
  for (const Binding::Turned& turned : binding.turned) {
    const auto [known, is_new] = frame_of_.try_emplace(turned.sphere, Index(to_.frame.size()));
    if (is_new) to_.frame.push_back(binding_.frame_of(turned.sphere));
    to_.turned.push_back({Index(to_.first.size()) - 1, known->second, turned.offset});
  }
  to_.first.push_back(Index(to_.sphere.size()));
}

SideBinding::SideBinding(const Model& model, const CutGrid& grid)
    : model_(model),
      organ_(model.organs[std::size_t(grid.organ())]),
      whole_(model.surfaces[std::size_t(grid.organ())]),
      grid_(grid),
      joined_(grid),
      nearest_(model, grid) {}

/// Vertices of one side differ in their places.
std::size_t SideBinding::KeyHash::operator()(const Key& key) const {
  return hash_of(key.place) + 4 * std::size_t(key.side) + 2 * std::size_t(key.is_outer) + std::size_t(key.is_wall);
}

void SideBinding::update(CutGrid::NodeBox changed) {
  // Vertices go where a cut goes on: those that were not asked for lately are forgotten.
  constexpr std::size_t kFew = 1024;
  if (bound_.size() > 2 * asked_ + kFew)
    std::erase_if(bound_, [&](const auto& known) { return known.second.round < joined_.round(); });
  asked_ = 0;
  changed_.push_back(changed);
  piece_.clear(), row_boxes_.clear(), nearest_.forget();
  joined_.update(changed);
}

/// Follows the spheres of a list within reach; empty if they do not span space.
SideBinding::Binding SideBinding::follow(Vec3 rest, std::span<const Joined> spheres, double reach) const {
  Binding binding;
  std::vector<Vec3> centres;
  std::vector<double> trust, near;
  for (const Joined& s : spheres) {
    const auto sphere = std::size_t(organ_.first + s.sphere);
    const double distance = norm(model_.rest_position[sphere] - rest);
    if (distance >= reach) continue;
    binding.sphere.push_back(s.sphere), centres.push_back(model_.rest_position[sphere]);
    trust.push_back(s.part * model_.mass[sphere]);
    const double bump = 1 - distance * distance / (reach * reach);
    near.push_back(trust.back() * bump * bump);
  }
  if (centres.size() < 4) return {};
  binding.depth = least_variance(centres, near) / (organ_.spacing * organ_.spacing);
  binding.weight = surface::follow_weights(rest, centres, trust, reach);
  Vec3 off = -rest;
  for (std::size_t i = 0; i < centres.size(); ++i) off += binding.weight[i] * centres[i];
  if (!(norm(off) < kOff * organ_.spacing)) return {};
  return binding;
}

/// Spheres of a piece within reach, ascending; -1: of all pieces.
std::vector<SideBinding::Joined> SideBinding::spheres_around(Vec3 rest, double reach, Index piece) const {
  std::vector<Joined> spheres;
  grid_.for_each_sphere_within(rest, reach, [&](Index s) {
    const Index node = grid_.node_of_sphere(s);
    if (piece < 0 || (node >= 0 && piece_[std::size_t(node)] == piece)) spheres.push_back({s, 1});
  });
  std::sort(spheres.begin(), spheres.end(), [](const Joined& a, const Joined& b) { return a.sphere < b.sphere; });
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
  SumBySphere<double> weight;
  const SurfaceBinding& whole = whole_.binding;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto v = std::size_t(whole_.triangle[std::size_t(origin.triangle)][i]);
    for (auto e = std::size_t(whole.first[v]); e < std::size_t(whole.first[v + 1]); ++e)
      weight.add(whole.sphere[e], origin.weight[i] * whole.weight[e]);
  }
  return {std::move(weight.sphere), std::move(weight.sum), 0, {}};
}

/// Takes a place of a wall back to the swept surface if it is off it, as beyond the end of a cut.
Vec3 SideBinding::near_cut(Vec3 rest, const State& state) {
  constexpr double kOffCut = 0.15;  // in steps of the grid
  if (row_boxes_.size() + 1 != cutting::swept_rows(state)) row_boxes_ = cutting::boxes_of_rows(state);
  // Most places are on it, which is found fast.
  if (cutting::is_near_swept(state, row_boxes_, grid_.organ(), rest, kOffCut * grid_.step())) return rest;
  return cutting::nearest_swept(state, row_boxes_, grid_.organ(), rest, kOntoCut * grid_.step()).value_or(rest);
}

const SideBinding::Bound& SideBinding::bind(const CutMesh::Vertex& vertex, bool is_outer, bool is_wall,
                                            const State& state) {
  const auto [found, is_new] = bound_.try_emplace({vertex.side, vertex.rest, is_outer, is_wall});
  Entry& entry = found->second;
  if (!is_new && entry.round == joined_.round()) return entry.bound;
  ++asked_;
  const bool was_known = !is_new && is_known(vertex, is_wall, state, entry);
  entry.round = joined_.round();
  if (was_known) return entry.bound;
  entry.put = is_wall ? near_cut(vertex.rest, state) : vertex.rest;
  bind(vertex.side, is_outer, entry);
  return entry.bound;
}

/// Whether what an entry depends on is as it was.
bool SideBinding::is_known(const CutMesh::Vertex& vertex, bool is_wall, const State& state, const Entry& entry) {
  // A cut far away may divide the piece that a vertex follows.
  if (entry.by_piece || !joined_.is_as_in(entry.round, entry.nodes)) return false;
  if (!is_wall) return true;
  // Rows of the cut beside a place change where it is put.
  constexpr Index kBeside = 4;
  static_assert(kBeside >= kSideSteps + kOntoCut);
  const bool is_near = std::any_of(changed_.begin() + entry.round, changed_.end(),
                                   [&](const auto& box) { return grid_.is_near(box, vertex.side, kBeside); });
  return !is_near || near_cut(vertex.rest, state) == entry.put;
}

void SideBinding::bind(Index side, bool is_outer, Entry& entry) {
  Bound& bound = entry.bound;
  bound = {entry.put, {}, {}}, entry.nodes.clear();
  if (is_outer) bound.origin = origin_of(bound.rest);
  const bool is_near_cut = side >= 0 && joined_.is_near_cut(side);
  if (side >= 0) joined_.go_to(bound.rest, side), entry.nodes = joined_.nodes();
  if (bound.origin.triangle >= 0) {
    const Vec3 place = place_of(bound.origin);
    if (norm(place - bound.rest) <= kOnSurface * organ_.spacing) {
      bound.rest = place, bound.binding = follow_whole(bound.origin);
      if (!is_near_cut || is_joined(bound.binding)) return;
    }
  }
  const double reach = surface::kBindingReach * organ_.spacing;
  const auto joined = [&](double within) {
    return side >= 0 ? joined_.within(bound.rest, within) : std::span<const Joined>();
  };
  Mix mix;
  mix.add(follow(bound.rest, joined(reach), reach), kNear);
  if (!mix.is_whole()) mix.add(follow(bound.rest, joined(kWider * reach), kWider * reach), kFar);
  if (!mix.is_whole()) {
    const Binding own = follow_frames(bound.rest, joined(reach), reach);
    mix.add(own, smooth(own.depth / kEnough));
  }
  entry.by_piece = !mix.is_whole();
  if (entry.by_piece) {
    const Binding near = follow_nearest(bound.rest);
    mix.add(near, near.depth);
  }
  if (!mix.is_whole()) {
    if (piece_.empty()) find_pieces();
    for (const Index piece : {piece_[std::size_t(side)], Index(-1)})
      if (!mix.is_whole()) follow_piece(bound.rest, piece, mix);
  }
  bound.binding = std::move(mix).binding();
}

/// Whether a binding follows spheres to which the place that joined_ went to is joined wholly.
bool SideBinding::is_joined(const Binding& binding) {
  constexpr double kWhole = 1 - 1e-9;
  return std::all_of(binding.sphere.begin(), binding.sphere.end(),
                     [&](Index sphere) { return joined_.part_of(sphere) > kWhole; });
}

/// Finds the pieces that vertices follow. One without spheres, as a strip thinner than a spacing may be, goes with the
/// piece that it shares most of its walls with: between two pieces that part it would be stretched.
void SideBinding::find_pieces() {
  piece_ = grid_.find_pieces();
  const Index count = Index(piece_.size());
  std::vector<std::uint8_t> is_led(piece_.size(), 0);  // by their lowest nodes: pieces that have spheres or a host
  for (Index s = 0; s < organ_.count; ++s)
    if (const Index node = grid_.node_of_sphere(s); node >= 0 && piece_[std::size_t(node)] >= 0)
      is_led[std::size_t(piece_[std::size_t(node)])] = 1;
  std::map<Index, Index> host;
  do {
    std::map<std::pair<Index, Index>, Index> shared;  // edges of the grid that a cut parts, by the pieces of both ends
    const auto add = [&](Index from, Index to) {
      const auto hosted = host.find(to);
      if (!is_led[std::size_t(from)] && is_led[std::size_t(to)])
        ++shared[{from, hosted == host.end() ? to : hosted->second}];
    };
    const bool is_alone = std::any_of(piece_.begin(), piece_.end(),
                                      [&](Index piece) { return piece >= 0 && !is_led[std::size_t(piece)]; });
    for (Index node = 0; node < count && is_alone; ++node)
      for (int d = 1; d < CutGrid::kDirections; ++d) {
        if (!grid_.is_severed(node, d)) continue;
        const Index a = piece_[std::size_t(node)], b = piece_[std::size_t(grid_.end(node, d))];
        add(a, b), add(b, a);
      }
    if (shared.empty()) break;
    std::map<Index, Index> most;
    for (const auto& [pieces, edges] : shared)
      if (edges > std::exchange(most[pieces.first], std::max(most[pieces.first], edges)))
        host[pieces.first] = pieces.second;
    for (const auto& [piece, edges] : most) is_led[std::size_t(piece)] = 1;
  } while (true);
  for (Index& piece : piece_)
    if (const auto hosted = host.find(piece); hosted != host.end()) piece = hosted->second;
}

/// Fills a mix up with the frames of a piece's spheres, from near ones to far ones, if it has any.
void SideBinding::follow_piece(Vec3 rest, Index piece, Mix& mix) const {
  const double reach = surface::kBindingReach * organ_.spacing;
  Binding widest;
  for (const double wider : {1.0, 2.0, 4.0}) {
    const Binding way = follow_frames(rest, spheres_around(rest, wider * reach, piece), wider * reach);
    mix.add(way, smooth(way.depth / kEnough));
    if (mix.is_whole()) return;
    if (!way.sphere.empty()) widest = way;
  }
  if (widest.sphere.empty()) widest = follow_any(rest, piece);
  if (!widest.sphere.empty()) mix.add(widest, 1);
}

/// Follows the one sphere of a piece that is nearest. Empty if there is none.
SideBinding::Binding SideBinding::follow_any(Vec3 rest, Index piece) const {
  Index nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const Joined& s : spheres_around(rest, least, piece)) {
    const double distance = norm(model_.rest_position[std::size_t(organ_.first + s.sphere)] - rest);
    if (distance < least) nearest = s.sphere, least = distance;
  }
  if (nearest < 0) return {};
  const Joined only{nearest, 1};
  return follow_frames(rest, {&only, 1}, 2 * least);
}

/// Follows those spheres that are the fewest edges away from the nodes of the place that joined_ went to, each the less
/// the farther it is: between two it changes evenly from one to the other. Its depth is the part of the nodes to which
/// one is near.
SideBinding::Binding SideBinding::follow_nearest(Vec3 rest) {
  constexpr double kFades = 4;  // edges
  SumBySphere<double> weight;
  double all = 0, found = 0;
  for (const JoinedSpheres::Weighted& n : joined_.weighted_nodes()) {
    const std::span<const NearestSpheres::Near> near = nearest_.of(n.node);
    all += n.weight;
    if (near.empty()) continue;
    const auto closeness = [](Index hops) { return 1.0 / (hops + 1) - 1.0 / (NearestSpheres::kMostHops + 2); };
    double sum = 0;
    for (const NearestSpheres::Near& s : near) sum += closeness(s.hops);
    const double part = n.weight * smooth((NearestSpheres::kMostHops - near.front().hops) / kFades);
    if (!(part > 0)) continue;
    for (const NearestSpheres::Near& s : near) weight.add(s.sphere, part * closeness(s.hops) / sum);
    found += part;
  }
  Binding binding;
  if (!(found > 0)) return binding;
  binding.depth = found / all;
  for (std::size_t i = 0; i < weight.sphere.size(); ++i) {
    const Index sphere = weight.sphere[i];
    const double part = weight.sum[i];
    const Vec3 off = rest - model_.rest_position[std::size_t(organ_.first + sphere)];
    binding.sphere.push_back(sphere), binding.weight.push_back(part / found);
    binding.turned.push_back({sphere, part / found * off});
  }
  return binding;
}

/// Follows spheres that are within reach, and turns with the frame of each. It fits where they do not span space, too,
/// and never throws a place out. How much they count in sum is its depth.
SideBinding::Binding SideBinding::follow_frames(Vec3 rest, std::span<const Joined> spheres, double reach) const {
  Binding binding;
  double sum = 0;
  for (const Joined& s : spheres) {
    const auto sphere = std::size_t(organ_.first + s.sphere);
    const Vec3 off = rest - model_.rest_position[sphere];
    const double bump = 1 - dot(off, off) / (reach * reach);
    const double weight = s.part * model_.mass[sphere] * bump * bump;
    if (!(bump > 0) || !(weight > 0)) continue;
    binding.depth += s.part * bump * bump;
    binding.sphere.push_back(s.sphere), binding.weight.push_back(weight), sum += weight;
    binding.turned.push_back({s.sphere, weight * off});
  }
  for (double& weight : binding.weight) weight /= sum;
  for (Binding::Turned& turned : binding.turned) turned.offset = turned.offset / sum;
  return binding;
}

/// How the tissue around a sphere turns: with the spheres that it is joined to.
const TissueFrame& SideBinding::frame_of(Index sphere) {
  const auto [found, is_new] = frames_.try_emplace(sphere);
  Frame& known = found->second;
  if (!is_new && joined_.is_as_in(known.round, known.nodes)) return known.frame;
  known = {{}, {}, joined_.round()};
  const auto centre = [&](Index s) { return model_.rest_position[std::size_t(organ_.first + s)]; };
  const double reach = kOfFrame * organ_.spacing;
  const Vec3 at = centre(sphere);
  TissueFrame& frame = known.frame;
  double sum = 0;
  const auto add = [&](Index s, double part) {
    const Vec3 off = centre(s) - at;
    const double bump = 1 - dot(off, off) / (reach * reach);
    const double weight = part * model_.mass[std::size_t(organ_.first + s)] * bump * bump;
    if (bump > 0 && weight > 0) frame.sphere.push_back(s), frame.weight.push_back(weight), sum += weight;
  };
  const Index home = grid_.home_of_sphere(sphere);
  if (home < 0) {
    add(sphere, 1);
  } else {
    joined_.go_to(grid_.rest(home), home);
    for (const Joined& s : joined_.within(at, reach)) add(s.sphere, s.part);
    known.nodes = joined_.nodes();
  }
  Vec3 mean;
  for (std::size_t i = 0; i < frame.sphere.size(); ++i)
    frame.weight[i] /= sum, mean += frame.weight[i] * centre(frame.sphere[i]);
  for (const Index s : frame.sphere) frame.arm.push_back(centre(s) - mean);
  return frame;
}

}  // namespace ctpm::cutbody
