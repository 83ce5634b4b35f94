#include "core/cutbody/torn_tissue.h"

#include <cmath>

#include "core/cutbody/cut_grid.h"

namespace ctpm::cutbody {
namespace {

using Index = CutGrid::Index;

/// Whether tissue goes on across an edge: a tear does not count as a cut.
bool is_whole(const CutGrid& grid, Index node, int direction) {
  return !grid.is_parted(node, direction) || grid.is_torn(node, direction);
}

}  // namespace

TornTissue::TornTissue(const Model& model, std::size_t organ, const cutting::TissueDepth& depth)
    : model_(model), organ_(organ), elements_(model, depth, organ), pieces_(model) {
  pieces_.find(network_);
  whole_ = pieces_.piece();
  network_.axial_severed.assign(model.axial.size(), 0);
}

void TornTissue::sever(const cutting::Front& from, const cutting::Front& to, const cutting::NewlySwept& newly,
                       bool may_move) {
  cutting::find_severed(model_, elements_, organ_, from, to, newly, network_.axial_severed,
                        may_move ? by_last_ : severed_);
}

void TornTissue::take_back() {
  for (const cutting::Crossing& crossing : by_last_) network_.axial_severed[std::size_t(crossing.element)] = 0;
  by_last_.clear();
}

void TornTissue::reset() {
  take_back();
  by_last_.swap(severed_), take_back();
}

/// For each node in tissue the piece of the spheres that are the fewest edges away in whole tissue; -1: none are. A
/// sphere outside the tissue is at the place where its elements are.
std::vector<Index> TornTissue::nearest_pieces(const CutGrid& grid, const State& state) const {
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
  std::vector<Index> of_node(std::size_t(grid.count()), -1), front, next;
  for (Index s = 0; s < organ.count; ++s) {
    const auto i = std::size_t(organ.first + s);
    const Index node = grid.is_inside(s) ? grid.home_of_sphere(s) : node_at(elements_.place(i));
    if (node < 0 || of_node[std::size_t(node)] >= 0) continue;
    of_node[std::size_t(node)] = pieces_.piece()[i], front.push_back(node);
  }
  for (; !front.empty(); front.swap(next), next.clear())
    for (const Index from : front) {
      const CutGrid::Node n = grid.node(from);
      const auto go = [&](CutGrid::Node to, Index lower, int direction) {
        const Index i = grid.at(to);
        if (!grid.in_tissue(i) || of_node[std::size_t(i)] >= 0 || !is_whole(grid, lower, direction)) return;
        of_node[std::size_t(i)] = of_node[std::size_t(from)], next.push_back(i);
      };
      for (int d = 1; d < CutGrid::kDirections; ++d) {
        const CutGrid::Node up{n[0] + (d & 1), n[1] + (d >> 1 & 1), n[2] + (d >> 2)},
            down{n[0] - (d & 1), n[1] - (d >> 1 & 1), n[2] - (d >> 2)};
        if (grid.contains(up)) go(up, from, d);
        if (grid.contains(down)) go(down, grid.at(down), d);
      }
    }
  return of_node;
}

TornTissue::Tear TornTissue::find(const CutGrid& grid, const State& state) {
  if (severed_.empty() && by_last_.empty()) return {};
  pieces_.find(network_);
  if (pieces_.piece() == whole_) return {};
  const std::vector<Index> nearest = nearest_pieces(grid, state);
  // What the network never held together is held by the tissue alone.
  const auto came_apart = [&](Index p, Index q) {
    return p >= 0 && q >= 0 && p != q && whole_[std::size_t(p)] == whole_[std::size_t(q)];
  };
  Tear tear;
  for (Index i = 0; i < grid.count(); ++i) {
    const CutGrid::Node n = grid.node(i);
    for (int d = 1; d < CutGrid::kDirections && nearest[std::size_t(i)] >= 0; ++d) {
      if (!grid.contains({n[0] + (d & 1), n[1] + (d >> 1 & 1), n[2] + (d >> 2)})) continue;
      const Index end = grid.end(i, d);
      if (came_apart(nearest[std::size_t(i)], nearest[std::size_t(end)]) && is_whole(grid, i, d))
        tear.edge.push_back({i, d});
    }
  }
  const OrganRange& organ = model_.organs[organ_];
  for (Index s = 0; s < organ.count; ++s)
    if (const Index home = grid.home_of_sphere(s); home >= 0 && !grid.is_inside(s))
      if (came_apart(pieces_.piece()[std::size_t(organ.first + s)], nearest[std::size_t(home)]))
        tear.stray.push_back(s);
  return tear;
}

}  // namespace ctpm::cutbody
