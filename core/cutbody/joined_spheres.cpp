#include "core/cutbody/joined_spheres.h"

#include <algorithm>
#include <array>
#include <utility>

namespace ctpm::cutbody {
namespace {

/// A place is joined to what the nodes of its side are joined to that are nearer than this, in steps of the grid (our
/// choice; its own node may be sqrt(3) steps away). They are found over so many edges.
constexpr double kBlur = 2;
static_assert(JoinedSpheres::kBlurHops >= kBlur);

/// The part of a sphere by the detour to it (our choice): a spacing more is around the end of a cut.
constexpr std::array<double, Sight::kMostDetour + 1> kPart{1, 0.75, 0.5, 0.25};

}  // namespace

std::vector<JoinedSpheres::Index> JoinedSpheres::nodes() const {
  std::vector<Index> nodes;
  for (const Weighted& n : nodes_) nodes.push_back(n.node);
  return nodes;
}

bool JoinedSpheres::is_as_in(std::uint32_t round, std::span<const Index> nodes) const {
  return std::all_of(nodes.begin(), nodes.end(), [&](Index node) { return sight_.changed_in(node) <= round; });
}

/// The nodes on the side of `side` around a place, and how much each counts.
void JoinedSpheres::find_nodes(Vec3 rest, Index side) {
  constexpr Index kSide = 2 * kBlurHops + 1;
  std::array<bool, std::size_t(kSide * kSide * kSide)> was_found{};
  const CutGrid::Node home = grid_.node(side);
  nodes_.clear();
  const auto find = [&](CutGrid::Node n) {
    bool& found = was_found[std::size_t(n[0] - home[0] + kBlurHops +
                                        kSide * (n[1] - home[1] + kBlurHops + kSide * (n[2] - home[2] + kBlurHops)))];
    if (std::exchange(found, true)) return;
    const Vec3 off = grid_.place(n) - rest;
    const double bump = 1 - dot(off, off) / (kBlur * kBlur * grid_.step() * grid_.step());
    if (bump > 0) nodes_.push_back({grid_.at(n), bump * bump});
  };
  find(home);
  std::size_t first = 0;
  for (Index hops = 0; hops < kBlurHops; ++hops)
    for (const std::size_t last = nodes_.size(); first < last; ++first) {
      const Index from = nodes_[first].node;
      const CutGrid::Node n = grid_.node(from);
      for (int d = 1; d < CutGrid::kDirections; ++d) {
        const CutGrid::Node up{n[0] + (d & 1), n[1] + (d >> 1 & 1), n[2] + (d >> 2)},
            down{n[0] - (d & 1), n[1] - (d >> 1 & 1), n[2] - (d >> 2)};
        const auto is_joined = [&](CutGrid::Node to, CutGrid::Node lower) {
          return grid_.contains(to) && grid_.in_tissue(grid_.at(to)) && !grid_.is_parted(grid_.at(lower), d);
        };
        if (is_joined(up, n)) find(up);
        if (is_joined(down, down)) find(down);
      }
    }
  // A place on the line between the organ's surface and a cut may be far from its node.
  if (nodes_.empty()) nodes_.push_back({side, 1});
}

void JoinedSpheres::go_to(Vec3 rest, Index side) {
  is_parted_ = sight_.has_cut(side);
  if (is_parted_)
    find_nodes(rest, side);
  else
    nodes_.assign(1, {side, 1});
  place_.clear(), total_ = 0;
  for (const Weighted& n : nodes_) place_.push_back(grid_.node(n.node)), total_ += n.weight;
}

double JoinedSpheres::part_of(Index sphere) {
  const Sight::View* view = sight_.view_of(sphere);
  if (view == nullptr) return 0;
  if (!is_parted_) return view->detour(place_.front()) < 0 ? 0 : 1;
  double sum = 0;
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    if (const Index detour = view->detour(place_[n]); detour >= 0) sum += nodes_[n].weight * kPart[std::size_t(detour)];
  return sum / total_;
}

std::span<const JoinedSpheres::Joined> JoinedSpheres::within(Vec3 centre, double reach) {
  joined_.clear();
  grid_.for_each_sphere_within(centre, reach, [&](Index sphere) {
    if (const double part = part_of(sphere); part > 0) joined_.push_back({sphere, part});
  });
  std::sort(joined_.begin(), joined_.end(), [](const Joined& a, const Joined& b) { return a.sphere < b.sphere; });
  return joined_;
}

}  // namespace ctpm::cutbody
