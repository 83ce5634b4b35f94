#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/model/organ.h"
#include "studio/render/cut_plane.h"
#include "studio/render/lattice_links.h"

namespace ctpm::render {

/// The vertices of a cut organ's surface. Each has a home, a sphere on its own side of the cut, and is bound only to
/// spheres that its home sees.
class CutVertices {
 public:
  using Index = std::int32_t;

  /// `links` must outlive this.
  explicit CutVertices(const LatticeLinks& links) : links_(links) {}

  /// Removes all vertices and clears the caches. Call it when links have changed.
  void clear();

  const LatticeLinks::Sight& sight(Index sphere);
  bool sees(Index sphere, Index other);   ///< over joined links, in as few hops as when uncut
  bool loses(Index sphere, Index other);  ///< the cut separates two spheres that saw each other
  /// Crossings of the links between what a sphere sees and what it lost.
  const std::vector<CutPoint>& crossings_around(Index sphere);

  Index add(Vec3 rest, Index home);
  /// Adds a vertex with the given binding.
  Index add(Vec3 rest, Index home, std::span<const Index> spheres, std::span<const double> weights);
  Index copy(Index vertex);  ///< a second vertex with the same position and binding

  const LatticeLinks& links() const { return links_; }
  Index count() const { return Index(surface_.vertex.size()); }
  Vec3 rest(Index vertex) const { return surface_.vertex[std::size_t(vertex)]; }
  Index home(Index vertex) const { return home_[std::size_t(vertex)]; }

  /// The vertices with their bindings, and the triangles that were added.
  Surface& surface() { return surface_; }
  const Surface& surface() const { return surface_; }

 private:
  void follow(Vec3 rest, Index home);

  const LatticeLinks& links_;
  Surface surface_;
  std::vector<Index> home_;                           ///< (vertex_count)
  std::map<Index, LatticeLinks::Sight> sights_;       ///< cache by sphere
  std::map<Index, std::vector<CutPoint>> crossings_;  ///< cache by sphere
  std::vector<std::pair<double, Index>> near_;        ///< scratch memory of follow()
};

}  // namespace ctpm::render
