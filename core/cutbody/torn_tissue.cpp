#include "core/cutbody/torn_tissue.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "core/cutbody/cut_grid.h"

namespace ctpm::cutbody {
namespace {

using Index = CutGrid::Index;

/// Two spheres that so many elements in a row join still hold the tissue between them (our choice). Around the end of a
/// cut between two rows of the lattice it is three.
constexpr int kMostElements = 4;

/// Whether tissue goes on across an edge: a tear does not count as a cut.
bool is_whole(const CutGrid& grid, Index node, int direction) {
  return !grid.is_parted(node, direction) || grid.is_torn(node, direction);
}

/// For each node in tissue the sphere that is the fewest edges away in whole tissue; -1: none is.
std::vector<Index> nearest_spheres(const CutGrid& grid, const OrganRange& organ) {
  std::vector<Index> of_node(std::size_t(grid.count()), -1), front, next;
  for (Index s = 0; s < organ.count; ++s) {
    const Index node = grid.node_of_sphere(s);
    if (node < 0 || of_node[std::size_t(node)] >= 0) continue;
    of_node[std::size_t(node)] = organ.first + s, front.push_back(node);
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
    : model_(model), organ_(organ), elements_(model, depth), is_severed_(model.axial.size(), 0) {}

void TornTissue::sever(const cutting::Front& from, const cutting::Front& to, const cutting::NewlySwept& newly,
                       bool may_move) {
  cutting::find_severed(model_, elements_, organ_, from, to, newly, is_severed_, may_move ? by_last_ : severed_);
}

void TornTissue::take_back() {
  for (const cutting::Crossing& crossing : by_last_) is_severed_[std::size_t(crossing.element)] = 0;
  by_last_.clear();
}

void TornTissue::reset() {
  take_back();
  by_last_.swap(severed_), take_back();
}

bool TornTissue::has_lost(Index sphere) const {
  const auto elements = elements_.of(std::size_t(sphere));
  return std::any_of(elements.begin(), elements.end(), [&](Index e) { return is_severed_[std::size_t(e)] != 0; });
}

/// Spheres and those that elements join to them, whole ones or, before any cut, all; ascending.
std::vector<Index> TornTissue::around(const std::vector<Index>& spheres, bool uncut) const {
  std::vector<Index> all(spheres);
  for (const Index s : spheres)
    for (const Index e : elements_.of(std::size_t(s))) {
      if (!uncut && is_severed_[std::size_t(e)]) continue;
      const Index a = model_.axial.a[std::size_t(e)];
      all.push_back(a == s ? model_.axial.b[std::size_t(e)] : a);
    }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Whether a way of few elements joins two spheres.
bool TornTissue::is_near(Index p, Index q, bool uncut) const {
  std::vector<Index> of_p{p}, of_q{q};
  const auto meet = [&] {
    std::vector<Index> both;
    std::set_intersection(of_p.begin(), of_p.end(), of_q.begin(), of_q.end(), std::back_inserter(both));
    return !both.empty();
  };
  for (int elements = 1; elements <= kMostElements; ++elements) {
    std::vector<Index>& grows = elements % 2 == 1 ? of_p : of_q;
    grows = around(grows, uncut);
    if (meet()) return true;
  }
  return false;
}

std::vector<TornTissue::Edge> TornTissue::find(const CutGrid& grid) {
  if (severed_.empty() && by_last_.empty()) return {};
  const std::vector<Index> nearest = nearest_spheres(grid, model_.organs[organ_]);
  std::map<std::pair<Index, Index>, bool> apart;  // of pairs of spheres
  const auto is_apart = [&](Index p, Index q) {
    const auto [known, is_new] = apart.try_emplace(std::minmax(p, q), false);
    // What the network never held is held by the tissue alone.
    if (is_new) known->second = has_lost(p) && has_lost(q) && !is_near(p, q, false) && is_near(p, q, true);
    return known->second;
  };
  std::vector<Edge> torn;
  for (Index i = 0; i < grid.count(); ++i) {
    const Index own = nearest[std::size_t(i)];
    if (own < 0) continue;
    const CutGrid::Node n = grid.node(i);
    for (int d = 1; d < CutGrid::kDirections; ++d) {
      if (!grid.contains({n[0] + (d & 1), n[1] + (d >> 1 & 1), n[2] + (d >> 2)})) continue;
      const Index other = nearest[std::size_t(grid.end(i, d))];
      if (other >= 0 && other != own && is_whole(grid, i, d) && is_apart(own, other)) torn.push_back({i, d});
    }
  }
  return torn;
}

}  // namespace ctpm::cutbody
