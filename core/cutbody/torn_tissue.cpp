#include "core/cutbody/torn_tissue.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cutbody/cut_grid.h"

namespace ctpm::cutbody {
namespace {

using Index = CutGrid::Index;

/// Whether tissue goes on across an edge: a tear does not count as a cut.
bool is_whole(const CutGrid& grid, Index node, int direction) {
  return !grid.is_parted(node, direction) || grid.is_torn(node, direction);
}

/// The spheres that carry the nodes of a grid, as far as they are asked for.
class Spreading {
 public:
  Spreading(const CutGrid& grid, std::vector<std::uint8_t> blocks)
      : by(std::size_t(grid.count()), -1),
        first(std::size_t(grid.sphere_count()), -1),
        grid_(grid),
        blocks_(std::move(blocks)) {}

  bool is_asked_for(Index node) const { return node >= 0 && blocks_[std::size_t(grid_.block(node))] != 0; }

  /// Lets a sphere carry a node that none carries.
  void begin_at(Index node, Index sphere) {
    if (node < 0 || by[std::size_t(node)] >= 0) return;
    by[std::size_t(node)] = sphere, front_.push_back(node);
    if (first[std::size_t(sphere)] < 0) first[std::size_t(sphere)] = node;
  }

  /// Goes on from the nodes where spheres begin, edge by edge in whole tissue, as long as nodes are carried by none.
  void spread() {
    for (std::vector<Index> next; !front_.empty(); front_.swap(next), next.clear())
      for (const Index from : front_)
        grid_.for_each_edge(from, [&](Index to, Index lower, int direction) {
          Index& sphere = by[std::size_t(to)];
          if (sphere >= 0 || !grid_.in_tissue(to) || !is_asked_for(to) || !is_whole(grid_, lower, direction)) return;
          sphere = by[std::size_t(from)], next.push_back(to);
        });
  }

  std::vector<Index> by, first;  ///< see TornTissue::Carried

 private:
  const CutGrid& grid_;
  const std::vector<std::uint8_t> blocks_;
  std::vector<Index> front_;
};

}  // namespace

TornTissue::TornTissue(const Model& model, std::size_t organ, const cutting::TissueDepth& depth)
    : model_(model), organ_(organ), elements_(model, depth, organ), pieces_(model) {
  pieces_.find(network_);
  whole_ = pieces_.piece();
  by_rows_.assign(model.axial.size(), 0);
}

void TornTissue::sever(const cutting::Front& from, const cutting::Front& to, const cutting::NewlySwept& newly,
                       bool may_move) {
  std::vector<cutting::Crossing> stays;
  cutting::find_severed(model_, elements_, organ_, from, to, newly, by_rows_, may_move ? by_last_ : stays);
}

void TornTissue::take_back() {
  for (const cutting::Crossing& crossing : by_last_) by_rows_[std::size_t(crossing.element)] = 0;
  by_last_.clear();
}

void TornTissue::reset() {
  std::fill(by_rows_.begin(), by_rows_.end(), std::uint8_t(0));
  by_last_.clear();
}

/// Marks the blocks of a grid around the spheres that lost an element: elsewhere nothing can tear.
std::vector<std::uint8_t> TornTissue::blocks_at_cut(const CutGrid& grid) const {
  std::vector<std::uint8_t> blocks(std::size_t(grid.block_count()), 0);
  const OrganRange& organ = model_.organs[organ_];
  for (std::size_t e = 0; e < network_.axial_severed.size(); ++e) {
    if (network_.axial_severed[e] == 0) continue;
    for (const Index sphere : {model_.axial.a[e] - organ.first, model_.axial.b[e] - organ.first})
      if (const Index home = sphere >= 0 && sphere < organ.count ? grid.home_of_sphere(sphere) : -1; home >= 0)
        blocks[std::size_t(grid.block(home))] = 1;
  }
  return grid.widened(blocks);
}

void TornTissue::take_severed(const State& state) {
  by_state_ = state.axial_severed, network_.axial_severed = by_rows_;
  for (std::size_t e = 0; e < by_state_.size(); ++e) network_.axial_severed[e] |= by_state_[e];
}

/// For each node in tissue the sphere that is the fewest edges away in whole tissue; -1: none is, or none is asked for.
/// A sphere outside the tissue is at the place where its elements are.
TornTissue::Carried TornTissue::carry(const CutGrid& grid, const State& state,
                                      const std::vector<std::uint8_t>& blocks) const {
  const cutting::SweptBoxes boxes = cutting::boxes_of_rows(state);
  const auto node_at = [&](Vec3 place) {
    Index nearest = -1;
    double least = INFINITY;
    for (const Index corner : grid.corners_around(place)) {
      const double distance = norm(grid.rest(corner) - place);
      if (!grid.in_tissue(corner) || !(distance < least)) continue;
      if (cutting::is_crossed(state, boxes, grid.organ(), place, grid.rest(corner))) continue;
      nearest = corner, least = distance;
    }
    return nearest;
  };
  const OrganRange& organ = model_.organs[organ_];
  Spreading carried(grid, grid.widened(blocks));
  std::vector<Index> outside;
  for (Index s = 0; s < organ.count; ++s)
    if (const Index home = grid.home_of_sphere(s); carried.is_asked_for(home))
      grid.is_inside(s) ? carried.begin_at(home, s) : outside.push_back(s);
  for (const Index s : outside) carried.begin_at(node_at(elements_.place(std::size_t(organ.first + s))), s);
  carried.spread();
  // Tissue in which no sphere has its place goes with the one outside that is nearest.
  const auto off = [&](Index s) {
    return norm(model_.rest_position[std::size_t(organ.first + s)] - grid.rest(grid.home_of_sphere(s)));
  };
  std::stable_sort(outside.begin(), outside.end(), [&](Index a, Index b) { return off(a) < off(b); });
  for (const Index s : outside) carried.begin_at(grid.home_of_sphere(s), s);
  carried.spread();
  return {std::move(carried.by), std::move(carried.first)};
}

/// Over how many elements, or whole ones only, the shortest way leads from one sphere to another of the organ; none
/// over at most so many.
std::optional<int> TornTissue::elements_between(Index from, Index to, int most, bool by_whole) {
  const Index first = model_.organs[organ_].first;
  reached_in_.resize(std::size_t(model_.organs[organ_].count), 0), ++search_;
  std::vector<Index> front{from}, next;
  reached_in_[std::size_t(from)] = search_;
  for (int hops = 0; hops < most; ++hops, front.swap(next), next.clear())
    for (const Index sphere : front)
      for (const Index element : elements_.of(std::size_t(first + sphere))) {
        const auto e = std::size_t(element);
        if (by_whole && network_.axial_severed[e] != 0) continue;
        const Index other = model_.axial.a[e] + model_.axial.b[e] - (first + sphere) - first;
        if (other == to) return hops + 1;
        if (std::exchange(reached_in_[std::size_t(other)], search_) != search_) next.push_back(other);
      }
  return std::nullopt;
}

/// Whether two spheres that the network held together are far from each other in it now, or apart. Around the end of a
/// cut there is a short way. Spheres that were farther apart before any cut are held together by the tissue alone.
bool TornTissue::came_apart(Index p, Index q) {
  constexpr int kHeld = 6, kShort = 4, kLonger = 2;  // elements
  if (p < 0 || q < 0 || p == q) return false;
  const auto [known, is_new] = apart_.try_emplace({std::min(p, q), std::max(p, q)}, false);
  if (!is_new) return known->second;
  const auto first = std::size_t(model_.organs[organ_].first), i = first + std::size_t(p), j = first + std::size_t(q);
  const bool is_loose = whole_[i] == whole_[j] && pieces_.piece()[i] != pieces_.piece()[j];
  if (is_loose) return known->second = true;
  const std::optional<int> uncut = elements_between(p, q, kHeld, false);
  return known->second = uncut && !elements_between(p, q, std::max(kShort, *uncut + kLonger), true);
}

TornTissue::Tear TornTissue::find(const CutGrid& grid, const State& state) {
  take_severed(state);
  if (std::none_of(network_.axial_severed.begin(), network_.axial_severed.end(), [](auto s) { return s != 0; }))
    return {};
  pieces_.find(network_), apart_.clear();
  const std::vector<std::uint8_t> blocks = blocks_at_cut(grid);
  const auto [nearest, first] = carry(grid, state, blocks);
  Tear tear;
  for (Index i = 0; i < grid.count(); ++i) {
    if (nearest[std::size_t(i)] < 0) continue;
    const CutGrid::Node n = grid.node(i);
    for (int d = 1; d < CutGrid::kDirections; ++d) {
      if (!grid.contains({n[0] + (d & 1), n[1] + (d >> 1 & 1), n[2] + (d >> 2)})) continue;
      const Index end = grid.end(i, d);
      if (nearest[std::size_t(i)] != nearest[std::size_t(end)] && is_whole(grid, i, d) &&
          came_apart(nearest[std::size_t(i)], nearest[std::size_t(end)]))
        tear.edge.push_back({i, d});
    }
  }
  const OrganRange& organ = model_.organs[organ_];
  for (Index s = 0; s < organ.count; ++s)
    if (const Index home = grid.home_of_sphere(s); home >= 0 && !grid.is_inside(s))
      if (came_apart(s, nearest[std::size_t(home)])) tear.stray.push_back({s, first[std::size_t(s)]});
  return tear;
}

}  // namespace ctpm::cutbody
