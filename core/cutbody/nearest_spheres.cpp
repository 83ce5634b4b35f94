#include "core/cutbody/nearest_spheres.h"

namespace ctpm::cutbody {

/// Goes out from all spheres at once, edge by edge, in the blocks around the cut.
void NearestSpheres::find() {
  near_.assign(std::size_t(grid_.count()), {});
  const std::vector<std::uint8_t> blocks = grid_.widened(grid_.widened(grid_.cut_blocks()));
  std::vector<Index> front, next;
  for (Index s = 0; s < grid_.sphere_count(); ++s) {
    const Index node = grid_.node_of_sphere(s);
    if (node < 0 || blocks[std::size_t(grid_.block(node))] == 0 || near_[std::size_t(node)].sphere >= 0) continue;
    near_[std::size_t(node)] = {s, 0}, front.push_back(node);
  }
  for (Index hops = 1; hops <= kMostHops; ++hops, front.swap(next), next.clear())
    for (const Index from : front)
      grid_.for_each_edge(from, [&](Index to, Index lower, int direction) {
        Near& near = near_[std::size_t(to)];
        if (near.sphere >= 0 || !grid_.in_tissue(to) || blocks[std::size_t(grid_.block(to))] == 0) return;
        if (grid_.is_parted(lower, direction)) return;
        near = {near_[std::size_t(from)].sphere, hops}, next.push_back(to);
      });
}

}  // namespace ctpm::cutbody
