#include "core/cutting/cut_front.h"

#include <algorithm>
#include <cmath>

#include "core/model/result.h"

namespace ctpm::cutting {
namespace {

/// Tissue is whole ahead of the front if the swept surface is farther than kCut from a place kAhead of it, and in full
/// if it is farther than kWhole [m].
constexpr double kAhead = 0.3e-3, kCut = 0.02e-3, kWhole = 0.1e-3;

/// Where an edge begins to cut tissue that is as whole as this, and goes on to cut it: they differ, so that an edge
/// along an earlier cut does not begin again in each tick.
constexpr double kBegins = 0.8, kGoesOn = 0.2;

/// Whether the last row of the swept surface ends at a node's front, and was cut there.
bool was_swept(const State& state, std::size_t node, Vec3 front) {
  if (state.swept_organ.empty()) return false;
  const std::size_t at = state.swept_organ.size() - kEdgeNodes + node;
  return state.swept_organ[at] != 0 && state.swept[at] == stored_place(front);
}

/// A node is followed from this far outside an organ [m], and at least from two nodes' distance.
constexpr double kNear = 3e-3;

/// The spheres within this many spacings span space wherever the front is. Sessions before physics revision 4 store
/// less, for another law.
constexpr double kLeastReach = 1.5;

/// From this depth on a place is in tissue in full, within what the depth tells [m].
constexpr double kDeep = 2e-3;

/// A place that is nearer to the swept surface than this is in the cut [m].
constexpr double kInCut = 0.3e-3;

/// Length over which a flank that leaves the tissue comes off it [m].
constexpr double kFlankEnds = 1e-3;
constexpr int kFlankPoints = 3;

/// Part of [0, 1] of a segment from `p` to `q` that is inside, where one end is and the other is not.
template <class Depth>
double share_inside(Vec3 p, Vec3 q, double at_p, double at_q, Depth&& depth) {
  constexpr int kHalvings = 8;
  if (std::abs(at_p) < TissueDepth::kBand && std::abs(at_q) < TissueDepth::kBand)
    return std::max(at_p, at_q) / (std::max(at_p, at_q) - std::min(at_p, at_q));
  double inside = at_p > 0 ? 0 : 1, outside = 1 - inside;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (depth(p + middle * (q - p)) > 0 ? inside : outside) = middle;
  }
  return std::abs(0.5 * (inside + outside) - (at_p > 0 ? 0 : 1));
}

/// Tissue between two nodes that are outside is looked for at places at most so far apart [m].
constexpr double kBetween = 1e-3;

/// Part of a segment that is inside, as places between its ends tell.
template <class Depth>
double share_between(Vec3 p, Vec3 q, Depth&& depth) {
  const double parts = std::ceil(norm(q - p) / kBetween);
  int inside = 0;
  for (double i = 1; i < parts; ++i) inside += depth(p + i / parts * (q - p)) > 0;
  return inside > 0 ? inside / parts : 0.0;
}

/// Mass of a sphere inside an organ that fills its surface [kg]; 0 if it has none.
double whole_mass(const Model& model, std::size_t organ) {
  if (organ >= model.surfaces.size() || model.surfaces[organ].triangle.empty()) return 0;
  const OrganRange& range = model.organs[organ];
  double mass = 0, volume = 0;
  for (std::int32_t i = range.first; i < range.first + range.count; ++i) mass += model.mass[std::size_t(i)];
  const Surface& surface = model.surfaces[organ];
  const Vec3 origin = surface.vertex.front();
  for (const auto& t : surface.triangle) {
    const auto at = [&](std::size_t c) { return surface.vertex[std::size_t(t[c])] - origin; };
    volume += dot(at(0), cross(at(1), at(2))) / 6;
  }
  return volume > 0 ? mass / volume * range.spacing * range.spacing * range.spacing : 0.0;
}

}  // namespace

CutFront::CutFront(const Model& model)
    : model_(model),
      map_(model),
      depth_(model, map_),
      swept_(model),
      elements_(model, depth_),
      bearing_(model, elements_),
      openings_(model, map_) {
  CTPM_CHECK(model.organs.size() < 255, "the swept surface names organs by a byte");
  for (const OrganRange& organ : model.organs)
    reach_.push_back(0), box_.emplace_back(model.rest_position[std::size_t(organ.first)]);
  for (std::size_t o = 0; o < model.organs.size(); ++o)
    has_volume_.push_back((o < model.surfaces.size() && !model.surfaces[o].triangle.empty()) || map_.has_cells(o));
  find_materials();
}

/// The tissue's resistance at each sphere, from that of its elements, each of which stands for an area across it. At an
/// organ's boundary an element stands for a part of it, and so does the sphere's mass.
void CutFront::find_materials() {
  const CutResistance& cut = model_.cut_resistance;
  if (!cut.any()) return;
  resists_ = true;
  material_.resize(model_.sphere_count());
  for (std::size_t o = 0; o < model_.organs.size(); ++o) {
    const OrganRange& organ = model_.organs[o];
    const auto first = std::size_t(organ.first), last = first + std::size_t(organ.count);
    const double of_surface = whole_mass(model_, o);
    double heaviest = of_surface;
    std::size_t most = 0;
    bool has_diagonals = false;
    for (std::size_t i = first; i < last; ++i) {
      if (of_surface == 0) heaviest = std::max(heaviest, model_.mass[i]);
      most = std::max(most, elements_.of(i).size());
      for (const std::int32_t e : elements_.of(i)) {
        const Vec3 d = model_.rest_position[std::size_t(model_.axial.b[std::size_t(e)])] -
                       model_.rest_position[std::size_t(model_.axial.a[std::size_t(e)])];
        has_diagonals = has_diagonals || norm(d) > 1.2 * organ.spacing;
      }
    }
    // So that the areas of all elements that a plane crosses sum to its own.
    const double area = organ.spacing * organ.spacing / (has_diagonals ? 1 + 2 * std::sqrt(2.0) : 1.0);
    for (std::size_t i = first; i < last; ++i) {
      double energy = 0, friction = 0, most_energy = 0, most_friction = 0;
      for (const std::int32_t e : elements_.of(i)) {
        energy += cut.energy[std::size_t(e)], friction += cut.friction[std::size_t(e)];
        most_energy = std::max(most_energy, cut.energy[std::size_t(e)]);
        most_friction = std::max(most_friction, cut.friction[std::size_t(e)]);
      }
      const double whole = area * double(most) * model_.mass[i] / heaviest;
      // Without a surface every sphere is whole, and one at the boundary has fewer elements.
      if (of_surface > 0) most_energy = most_friction = 0;
      material_[i].toughness = std::max(most_energy / area, energy / whole);
      material_[i].flank_stress = 0.5 * std::max(most_friction / area, friction / whole);
    }
  }
}

/// Finds the organ that a node is in or near, and where in it its front begins.
void CutFront::track(std::size_t node, Vec3 from, Vec3 to, bool is_taken, State& state) const {
  std::int32_t& organ = state.edge_organ[node];
  const Box way(from, to);
  if (organ >= 0 && !box_[std::size_t(organ)].meets(way)) organ = -1;
  if (organ >= 0 && (box_.size() == 1 || depth_.at(std::size_t(organ), state.blade_trail[node]) > 0)) return;
  double deepest = organ >= 0 ? depth_.at(std::size_t(organ), state.blade_trail[node]) : -INFINITY;
  for (std::size_t o = 0; o < box_.size(); ++o) {
    if (std::int32_t(o) == organ || !box_[o].meets(way)) continue;
    const Vec3 rest = map_.rest_of(o, state.position, to, reach_[o], &bearing_);
    const double depth = depth_.at(o, rest);
    if (depth <= deepest) continue;
    deepest = depth, organ = std::int32_t(o);
    state.blade_trail.set(node, is_taken ? rest : map_.rest_of(o, state.position, from, reach_[o], &bearing_));
  }
}

void CutFront::begin_tick(const Tool& scalpel, const BladeEdge& from, const BladeEdge& to, bool is_taken,
                          State& state) {
  last_edge_ = from;
  bearing_.update(state);
  if (state.edge_organ.size() != kEdgeNodes || state.blade_trail.size() != kEdgeNodes)
    state.blade_trail.resize(kEdgeNodes), state.edge_organ.assign(kEdgeNodes, -1);
  if (is_taken) std::fill(state.edge_organ.begin(), state.edge_organ.end(), -1);
  const double apart = norm(to.heel - to.tip) / double(kEdgeNodes - 1 - kPointNodes);
  const Box edge(from.tip, from.heel, from.back, to.tip, to.heel, to.back);
  bool is_near = false;
  for (std::size_t o = 0; o < model_.organs.size(); ++o) {
    const auto first = std::size_t(model_.organs[o].first), last = first + std::size_t(model_.organs[o].count);
    Box box(state.position[first]);
    for (std::size_t i = first; i < last; ++i) box.add(state.position[i]);
    reach_[o] = std::max({scalpel.blade_reach, model_.organs[o].blade_reach,
                          std::max(scalpel.blade_reach_spacings, kLeastReach) * model_.organs[o].spacing});
    box_[o] = box.grown(std::max(kNear, 2 * apart));
    is_near = is_near || box_[o].meets(edge);
  }
  if (!is_near) {
    std::fill(state.edge_organ.begin(), state.edge_organ.end(), -1);
    return;
  }
  for (std::size_t n = 0; n < kEdgeNodes; ++n) track(n, at_node(from, n), at_node(to, n), is_taken, state);
}

void CutFront::begin_substep(const State& state) {
  state_ = &state;
  swept_.update(state), bearing_.update(state);
  for (std::size_t n = 0; n < kEdgeNodes; ++n) {
    Node& node = nodes_[n];
    front_[n] = state.blade_trail[n];
    node.organ = state.edge_organ[n], node.edge = {}, node.has_tissue = false,
    node.length = node.toughness = node.flank_stress = 0;
    if (node.organ < 0) continue;
    const auto organ = std::size_t(node.organ);
    const BladeAt blade{bearing_, state.position, at_node(last_edge_, n)};
    map_.find(organ, front_[n], reach_[organ], node.place, &blade);
    node.depth = depth_.at(organ, front_[n]);
    if (!resists_ || node.place.count == 0) continue;
    double total = 0;
    for (std::size_t i = 0; i < std::size_t(node.place.count); ++i) {
      const double weight = std::max(0.0, node.place.weight[i]);
      const Material& material = material_[std::size_t(node.place.sphere[i])];
      total += weight;
      node.toughness += weight * material.toughness, node.flank_stress += weight * material.flank_stress;
    }
    node.toughness /= total, node.flank_stress /= total;
  }
  for (std::size_t n = 0; n + 1 < kEdgeNodes; ++n) {
    Node &p = nodes_[n], &q = nodes_[n + 1];
    if (p.organ < 0 || p.organ != q.organ) continue;
    const Vec3 edge = front_[n + 1] - front_[n];
    const double apart = norm(edge);
    p.edge += edge, q.edge += edge;
    const bool in_p = p.depth > 0, in_q = q.depth > 0;
    const auto depth = [&](Vec3 rest) { return depth_.at(std::size_t(p.organ), rest); };
    if (in_p == in_q) {
      const double share = in_p ? 1 : share_between(front_[n], front_[n + 1], depth);
      p.length += 0.5 * share * apart, q.length += 0.5 * share * apart;
      p.has_tissue = p.has_tissue || share > 0, q.has_tissue = q.has_tissue || share > 0;
      continue;
    }
    Node& inside = in_p ? p : q;
    inside.length += apart * share_inside(front_[n], front_[n + 1], p.depth, q.depth, depth);
  }
}

/// How much of the tissue that the front meets on its way from `rest` is whole, from 0 to 1.
double CutFront::newness(std::int32_t organ, Vec3 rest, Vec3 way_at_rest) const {
  const double length = norm(way_at_rest);
  if (!(length > 0)) return 0;
  const double distance = swept_.distance(*state_, organ, rest + kAhead / length * way_at_rest);
  return std::clamp((distance - kCut) / (kWhole - kCut), 0.0, 1.0);
}

double CutFront::in_tissue(std::size_t organ, Vec3 rest) const {
  const double share = std::clamp(depth_.at(organ, rest) / kDeep, 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

double CutFront::in_cut(std::size_t organ, Vec3 rest) const {
  const double distance = swept_.distance(*state_, std::int32_t(organ), rest, kInCut);
  return std::clamp((SweptIndex::kFar - distance) / (SweptIndex::kFar - kInCut), 0.0, 1.0);
}

/// How wide the faces of the cut gape around a place, along the unit vector `across` [m].
double CutFront::opening(const Place& at, const StateView& state, Vec3 across) const {
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < std::size_t(at.count); ++i) {
    if (!bearing_.has_severed(at.sphere[i])) continue;
    for (const std::int32_t element : elements_.of(std::size_t(at.sphere[i]))) {
      const auto e = std::size_t(element);
      if (!state.axial_severed[e]) continue;
      const auto a = std::size_t(model_.axial.a[e]), b = std::size_t(model_.axial.b[e]);
      const Vec3 rest = model_.rest_position[b] - model_.rest_position[a], now = state.position[b] - state.position[a];
      const double crossing = std::abs(dot(across, rest)), weight = std::max(0.0, at.weight[i]) * crossing;
      sum += weight * (std::abs(dot(across, now)) - crossing), total += weight;
    }
  }
  return total > 0 ? std::max(0.0, sum / total) : 0.0;
}

/// Height of a flank behind the edge that tissue touches [m].
double CutFront::rubbed_height(std::size_t n, const Tool& scalpel, const StateView& state, Vec3 edge, Vec3 way) const {
  const Node& node = nodes_[n];
  const Vec3 behind = node.place.at_rest(state.position, -scalpel.flank_height * way);
  double share = 0;
  for (int i = 0; i < kFlankPoints; ++i) {
    const double depth = depth_.at(std::size_t(node.organ), front_[n] + (i + 0.5) / kFlankPoints * behind);
    share += std::clamp(0.5 + depth / kFlankEnds, 0.0, 1.0) / kFlankPoints;
  }
  const Vec3 normal = cross(edge, way);
  const double size = norm(normal);
  const double gap = share > 0 && size > 0 ? opening(node.place, state, normal / size) : 0.0;
  return scalpel.flank_height * share * std::clamp(2 - gap / scalpel.blade_thickness, 0.0, 1.0);
}

double CutFront::hold(std::size_t n, const Tool& scalpel, const StateView& state, Vec3 edge, Vec3 way) const {
  const Node& node = nodes_[n];
  if (node.length == 0) return 0;
  double per_length = 0;
  if (node.toughness > 0) {
    // The area is that of the tissue at rest, which the blade compresses or stretches.
    const Vec3 at_rest = node.place.at_rest(state.position, way);
    const double area = norm(cross(node.edge, at_rest)) / norm(node.edge);
    per_length += node.toughness * area * newness(node.organ, front_[n], at_rest);
  }
  if (node.flank_stress > 0 && n >= kPointNodes)
    per_length += 2 * node.flank_stress * rubbed_height(n, scalpel, state, edge, way);
  return node.length * per_length;
}

/// Draws each node after the edge, up to the distance at which the tissue holds it.
CutFront::Step CutFront::draw(const Tool& scalpel, const BladeEdge& edge, const State& state) const {
  Step step{front_, {}};
  for (std::size_t n = 0; n < kEdgeNodes; ++n) {
    const Node& node = nodes_[n];
    if (node.organ < 0) continue;
    const auto organ = std::size_t(node.organ);
    if (node.place.count == 0) {
      // Nothing holds a node far outside, or where the tissue fell away from the blade.
      step.to[n] = map_.rest_of(organ, state.position, at_node(edge, n), reach_[organ], &bearing_);
      step.cuts[n] = node.depth <= 0;
    } else {
      const Vec3 apart = at_node(edge, n) - node.place.at(state.position);
      const double distance = norm(apart);
      if (!(distance > 0)) continue;
      const bool cuts = leads(edge, n, apart);
      const double held =
          cuts && hold(n, scalpel, state, along_node(edge, n), apart / distance) > 0 ? scalpel.trail_distance : 0.0;
      if (distance <= held) continue;
      Vec3 move = node.place.at_rest(state.position, (1 - held / distance) * apart);
      // The spheres that carry the front tell nothing of tissue beyond their reach.
      const double length = norm(move), most = reach_[organ];
      if (length > most) move = most / length * move;
      step.to[n] = front_[n] + move;
      const bool is_outside = !node.has_tissue && node.depth <= 0 && depth_.at(organ, step.to[n]) <= 0;
      const Vec3 by_blade = at_node(edge, n) - at_node(last_edge_, n);
      step.cuts[n] = cuts && (!is_outside || 2 * dot(apart, by_blade) > distance * distance);
    }
  }
  return step;
}

/// Where the step goes through tissue that was whole.
NewlySwept CutFront::newly_swept(const Step& step, const State& state) const {
  std::array<double, kEdgeNodes> is_new{};
  for (std::size_t n = 0; n < kEdgeNodes; ++n)
    if (step.cuts[n]) is_new[n] = newness(nodes_[n].organ, front_[n], step.to[n] - front_[n]);
  const auto is_in = [&](std::size_t n) {
    const auto organ = std::size_t(nodes_[n].organ);
    return nodes_[n].depth > 0 || depth_.at(organ, step.to[n]) > 0 ||
           depth_.at(organ, 0.5 * (front_[n] + step.to[n])) > 0;
  };
  NewlySwept newly{};
  for (std::size_t n = 0; n + 1 < kEdgeNodes; ++n) {
    if (nodes_[n].organ < 0 || nodes_[n].organ != nodes_[n + 1].organ) continue;
    const double is_whole = n < kPointNodes ? is_new[n] : std::max(is_new[n], is_new[n + 1]);
    if (is_whole < (was_swept(state, n, front_[n]) ? kGoesOn : kBegins)) continue;
    const auto organ = std::size_t(nodes_[n].organ);
    const auto is_between = [&](const Front& front) {
      return share_between(front[n], front[n + 1], [&](Vec3 rest) { return depth_.at(organ, rest); }) > 0;
    };
    if (has_volume_[organ] == 0 || is_in(n) || is_in(n + 1) || is_between(front_) || is_between(step.to))
      newly[n] = std::uint8_t(1 + nodes_[n].organ);
  }
  return newly;
}

/// The front from which a step sweeps. A node outside is taken along by the tissue that moves under it, and sweeps
/// nothing on that way; where its neighbour inside goes on from where it rested, the cut would have a hole.
Front CutFront::begin_of(const NewlySwept& newly, const State& state) const {
  Front from = front_;
  for (std::size_t n = 0; n + 1 < kEdgeNodes; ++n) {
    if (newly[n] == 0) continue;
    std::size_t row = swept_rows(state);
    while (row > 1 && state.swept_organ[(row - 1) * kEdgeNodes + n] != newly[n]) --row;
    if (row <= 1) continue;
    const std::size_t at = (row - 1) * kEdgeNodes + n;
    const bool first_rests = state.swept[at] == stored_place(front_[n]),
               second_rests = state.swept[at + 1] == stored_place(front_[n + 1]);
    if (first_rests == second_rests) continue;
    const std::size_t slid = first_rests ? 1 : 0;
    const Vec3 before = state.swept[at + slid];
    const auto organ = std::size_t(newly[n] - 1);
    if (depth_.at(organ, front_[n + slid]) <= 0 && norm(before - front_[n + slid]) < reach_[organ])
      from[n + slid] = before;
  }
  return from;
}

std::int32_t CutFront::follow(const Tool& scalpel, const BladeEdge& edge, State& state,
                              std::vector<Crossing>& crossings) {
  const Step step = draw(scalpel, edge, state);
  const NewlySwept newly = newly_swept(step, state);
  const Front from = begin_of(newly, state);
  for (std::size_t n = 0; n < kEdgeNodes; ++n) state.blade_trail.set(n, step.to[n]);
  last_edge_ = edge;
  if (std::none_of(newly.begin(), newly.end(), [](std::uint8_t organ) { return organ != 0; })) return 0;
  add_swept(state, from, step.to, newly);
  return sever_swept(model_, elements_, from, step.to, newly, state, crossings);
}

}  // namespace ctpm::cutting
