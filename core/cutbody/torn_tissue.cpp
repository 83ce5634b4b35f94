#include "core/cutbody/torn_tissue.h"

#include "core/cutbody/cut_grid.h"

namespace ctpm::cutbody {
namespace {

using Index = CutGrid::Index;

/// Whether tissue goes on across an edge: a tear does not count as a cut.
bool is_whole(const CutGrid& grid, Index node, int direction) {
  return !grid.is_parted(node, direction) || grid.is_torn(node, direction);
}

/// For each node in tissue the piece of the spheres that are the fewest edges away in whole tissue; -1: none are.
std::vector<Index> nearest_pieces(const CutGrid& grid, const OrganRange& organ, const std::vector<Index>& piece) {
  std::vector<Index> of_node(std::size_t(grid.count()), -1), front, next;
  for (Index s = 0; s < organ.count; ++s) {
    const Index node = grid.node_of_sphere(s);
    if (node < 0 || of_node[std::size_t(node)] >= 0) continue;
    of_node[std::size_t(node)] = piece[std::size_t(organ.first + s)], front.push_back(node);
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

}  // namespace

TornTissue::TornTissue(const Model& model, std::size_t organ, const cutting::TissueDepth& depth)
    : model_(model), organ_(organ), elements_(model, depth), pieces_(model) {
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

std::vector<TornTissue::Edge> TornTissue::find(const CutGrid& grid) {
  if (severed_.empty() && by_last_.empty()) return {};
  pieces_.find(network_);
  const std::vector<Index>& piece = pieces_.piece();
  if (piece == whole_) return {};
  const std::vector<Index> nearest = nearest_pieces(grid, model_.organs[organ_], piece);
  std::vector<Edge> torn;
  for (Index i = 0; i < grid.count(); ++i) {
    const Index own = nearest[std::size_t(i)];
    if (own < 0) continue;
    const CutGrid::Node n = grid.node(i);
    for (int d = 1; d < CutGrid::kDirections; ++d) {
      if (!grid.contains({n[0] + (d & 1), n[1] + (d >> 1 & 1), n[2] + (d >> 2)})) continue;
      const Index other = nearest[std::size_t(grid.end(i, d))];
      if (other < 0 || other == own || !is_whole(grid, i, d)) continue;
      // What the network never held together is held by the tissue alone.
      if (whole_[std::size_t(own)] == whole_[std::size_t(other)]) torn.push_back({i, d});
    }
  }
  return torn;
}

}  // namespace ctpm::cutbody
