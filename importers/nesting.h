#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "importers/mesh.h"
#include "importers/topology.h"

namespace ctpm::importers {

/// Whether a shell lies inside another that it does not cross. `outer` may have small holes.
bool is_inside(const Soup& inner, const Soup& outer);

/// Finds the part of a file that a repaired mesh came from, by the places of its vertices.
class PartVote {
 public:
  PartVote(const RawMesh& mesh, double unit_in_metres);

  /// Index in RawMesh::parts of most of the vertices [m]; -1: not known.
  std::int32_t part_of(const std::vector<Vec3>& vertex) const;

 private:
  std::size_t part_count_;
  bool is_only_part_;
  std::unordered_map<std::uint64_t, std::int32_t> part_at_;  ///< by the hash of a position
};

}  // namespace ctpm::importers
