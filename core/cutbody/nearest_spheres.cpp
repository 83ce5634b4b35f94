#include "core/cutbody/nearest_spheres.h"

#include <algorithm>

namespace ctpm::cutbody {

void NearestSpheres::forget() {
  for (const Nears& near : near_) number_[std::size_t(near.node)] = -1;
  near_.clear(), is_found_ = false;
}

bool NearestSpheres::is_apart(Index sphere, Index other) const {
  const OrganRange& organ = model_.organs[std::size_t(grid_.organ())];
  const auto at = [&](Index s) { return model_.rest_position[std::size_t(organ.first + s)]; };
  return sphere != other && norm(at(sphere) - at(other)) > kApart * organ.spacing;
}

/// Adds a sphere to those of a node; false if it is one of them, or so near to one that that stands for both.
bool NearestSpheres::add(Reached reached, Index hops) {
  Index& number = number_[std::size_t(reached.node)];
  if (number < 0) number = Index(near_.size()), near_.push_back({reached.node});
  Nears& near = near_[std::size_t(number)];
  const auto end = near.sphere.begin() + near.count;
  if (near.count == Index(kMost) ||
      !std::all_of(near.sphere.begin(), end, [&](const Near& other) { return is_apart(reached.sphere, other.sphere); }))
    return false;
  *end = {reached.sphere, hops}, ++near.count;
  return true;
}

/// Goes out from all spheres at once, edge by edge, in the blocks around the cut.
void NearestSpheres::find() {
  is_found_ = true;
  number_.resize(std::size_t(grid_.count()), -1);
  const std::vector<std::uint8_t> blocks = grid_.widened(grid_.widened(grid_.cut_blocks()));
  std::vector<Reached> front, next;
  for (Index s = 0; s < grid_.sphere_count(); ++s)
    if (const Index node = grid_.node_of_sphere(s); node >= 0 && blocks[std::size_t(grid_.block(node))] != 0)
      if (add({node, s}, 0)) front.push_back({node, s});
  for (Index hops = 1; hops <= kMostHops; ++hops, front.swap(next), next.clear())
    for (const Reached& from : front)
      grid_.for_each_edge(from.node, [&](Index to, Index lower, int direction) {
        if (!grid_.in_tissue(to) || blocks[std::size_t(grid_.block(to))] == 0) return;
        if (grid_.is_parted(lower, direction)) return;
        if (add({to, from.sphere}, hops)) next.push_back({to, from.sphere});
      });
}

}  // namespace ctpm::cutbody
