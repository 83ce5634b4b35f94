#include "core/cutbody/joined_spheres.h"

#include <algorithm>
#include <array>
#include <bit>
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

const Sight::Seen& JoinedSpheres::seen_from(Index node) {
  const auto [found, is_new] = seen_.try_emplace(node);
  Known& known = found->second;
  if (is_new || sight_.changed_in(node) > known.round) known.seen = sight_.from(node);
  known.round = round();
  return known.seen;
}

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

std::span<const JoinedSpheres::Joined> JoinedSpheres::around(Vec3 rest, Index side) {
  joined_.clear(), nodes_.assign(1, {side, 1});
  if (const Sight::Seen& seen = seen_from(side); !seen.has_cut) {
    for (const Sight::Seen::Sphere& s : seen.sphere) joined_.push_back({s.sphere, 1});
    return joined_;
  }
  find_nodes(rest, side);
  sum_.resize(std::size_t(grid_.sphere_count()), 0), is_known_.resize(sum_.size() / kWord + 1, 0);
  double total = 0;
  for (const Weighted& n : nodes_) {
    total += n.weight;
    std::array<double, kPart.size()> share;
    for (std::size_t detour = 0; detour < share.size(); ++detour) share[detour] = n.weight * kPart[detour];
    for (const Sight::Seen::Sphere& s : seen_from(n.node).sphere) {
      sum_[std::size_t(s.sphere)] += share[std::size_t(s.detour)];
      is_known_[std::size_t(s.sphere) / kWord] |= std::uint64_t(1) << (std::size_t(s.sphere) % kWord);
    }
  }
  for (std::size_t word = 0; word < is_known_.size(); ++word)
    for (std::uint64_t left = std::exchange(is_known_[word], 0); left != 0; left &= left - 1) {
      const std::size_t s = word * kWord + std::size_t(std::countr_zero(left));
      joined_.push_back({Index(s), std::exchange(sum_[s], 0) / total});
    }
  return joined_;
}

}  // namespace ctpm::cutbody
