#include "studio/render/open_edges.h"

namespace ctpm::render {

void OpenEdges::add(std::int32_t from, std::int32_t to) {
  const auto opposite = count_.find({to, from});
  if (opposite == count_.end())
    ++count_[{from, to}];
  else if (--opposite->second == 0)
    count_.erase(opposite);
}

std::vector<std::vector<std::int32_t>> OpenEdges::take_loops() {
  std::vector<std::vector<std::int32_t>> loops;
  while (!count_.empty()) {
    // Walks along open edges until a vertex repeats; the vertices between are a loop.
    std::vector<std::int32_t> way{count_.begin()->first.first};
    std::map<std::int32_t, std::size_t> place{{way[0], 0}};
    do {
      const auto edge = count_.lower_bound({way.back(), -1});
      if (edge == count_.end() || edge->first.first != way.back()) {
        place.erase(way.back()), way.pop_back();  // a border of the input surface, not a loop
        continue;
      }
      const std::int32_t next = edge->first.second;
      if (--edge->second == 0) count_.erase(edge);
      const auto seen = place.find(next);
      if (seen == place.end()) {
        place[next] = way.size(), way.push_back(next);
        continue;
      }
      const std::size_t begin = seen->second;
      loops.emplace_back(way.begin() + std::ptrdiff_t(begin), way.end());
      for (std::size_t i = begin + 1; i < way.size(); ++i) place.erase(way[i]);
      way.resize(begin + 1);
    } while (way.size() > 1);
  }
  return loops;
}

}  // namespace ctpm::render
