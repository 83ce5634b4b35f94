#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace ctpm::render {

/// The directed edges of triangles that have no opposite. Those of closed surfaces with holes form loops.
class OpenEdges {
 public:
  /// A triangle's edge, as the triangle walks it.
  void add(std::int32_t from, std::int32_t to);

  bool none() const { return count_.empty(); }

  /// Takes them all and returns the loops among them, in which no vertex comes twice; each loop's last vertex is joined
  /// to its first.
  std::vector<std::vector<std::int32_t>> take_loops();

 private:
  std::map<std::pair<std::int32_t, std::int32_t>, int> count_;
};

}  // namespace ctpm::render
