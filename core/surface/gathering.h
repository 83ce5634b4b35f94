#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/model/organ.h"

namespace ctpm::surface {

/// At which vertices of surfaces a pressure is gathered: for all of a facet at the vertex nearest to its middle at
/// rest. Surfaces are finer than what the spheres resolve, and each gathered force is a contact that the solver bears.
class Gathering {
 public:
  using Index = std::int32_t;

  /// Adds a surface, whose vertices are numbered after those of the surfaces before. `radius` [m]: of its facets.
  void add(const Surface& surface, double radius);

  /// The vertex at which what presses on a vertex is gathered.
  Index at(Index vertex) const { return at_[std::size_t(vertex)]; }

  /// The vertices whose pressure is gathered at a vertex, ascending; none if it is gathered elsewhere.
  std::span<const Index> gathered_at(Index vertex) const {
    const auto begin = std::size_t(first_[std::size_t(vertex)]), end = std::size_t(first_[std::size_t(vertex) + 1]);
    return std::span(members_).subspan(begin, end - begin);
  }

 private:
  std::vector<Index> at_;        ///< (vertex_count)
  std::vector<Index> first_{0};  ///< in members_ (vertex_count + 1)
  std::vector<Index> members_;   ///< (vertex_count)
};

}  // namespace ctpm::surface
