#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace ctpm::render {

/// The directed triangle edges that have no opposite. On a surface with holes they form loops.
class OpenEdges {
 public:
  /// Adds a triangle's edge in the triangle's direction.
  void add(std::int32_t from, std::int32_t to);

  bool none() const { return count_.empty(); }

  /// Removes all edges and returns the loops among them. No vertex occurs twice in a loop; its last vertex is joined to
  /// its first.
  std::vector<std::vector<std::int32_t>> take_loops();

 private:
  std::map<std::pair<std::int32_t, std::int32_t>, int> count_;
};

}  // namespace ctpm::render
