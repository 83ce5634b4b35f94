#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/cutbody/cut_grid.h"
#include "core/cutbody/cut_mesh.h"

namespace ctpm::cutbody {

/// Vertices by what they lie on. They keep their numbers from round to round; in each, their places are found again
/// where they are asked for.
class Vertices {
 public:
  using Index = CutGrid::Index;

  explicit Vertices(const CutGrid& grid) : grid_(grid) {}

  void begin_round() { ++round_; }
  void forget() { number_.clear(), all_.clear(), round_of_.clear(); }

  /// The vertex on the simplex of `count` nodes (ascending; 2: an edge, 3: a face, 4: a tetrahedron) on the side of
  /// `side`. `place()` gives its place at rest.
  template <class Place>
  Index at(const Index* nodes, int count, Index side, Place&& place) {
    const auto [found, is_new] = number_.try_emplace(key(nodes, count, side), Index(all_.size()));
    const Index number = found->second;
    if (is_new) all_.emplace_back(), round_of_.push_back(round_ - 1);
    if (round_of_[std::size_t(number)] != round_)
      round_of_[std::size_t(number)] = round_, all_[std::size_t(number)] = {place(), side};
    return number;
  }
  const CutMesh::Vertex& operator[](Index v) const { return all_[std::size_t(v)]; }
  std::size_t count() const { return all_.size(); }

 private:
  /// A simplex is known by its lowest node and the directions from it to the others.
  std::uint64_t key(const Index* nodes, int count, Index side) const {
    std::uint64_t result = std::uint64_t(nodes[0]) * 8;
    const CutGrid::Node low = grid_.node(nodes[0]);
    const auto direction = [&](Index n) {
      const CutGrid::Node at = grid_.node(n);
      return std::uint64_t((at[0] - low[0]) | (at[1] - low[1]) << 1 | (at[2] - low[2]) << 2);
    };
    for (int i = 1; i < 4; ++i) result = result * 8 + (i < count ? direction(nodes[i]) : 0);
    return result * 8 + direction(side);
  }

  const CutGrid& grid_;
  std::unordered_map<std::uint64_t, Index> number_;
  std::vector<CutMesh::Vertex> all_;
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> round_of_;  ///< in which their places were found
};

/// Which of numbered things, vertices or triangles of a mesh, belong together: the first of them stands for all.
class DisjointSets {
 public:
  using Index = CutGrid::Index;

  Index add() {
    root_.push_back(Index(root_.size()));
    return root_.back();
  }
  void join(Index a, Index b) {
    a = root(a), b = root(b);
    root_[std::size_t(std::max(a, b))] = std::min(a, b);
  }
  Index root(Index i) {
    while (root_[std::size_t(i)] != i) i = root_[std::size_t(i)] = root_[std::size_t(root_[std::size_t(i)])];
    return i;
  }

 private:
  std::vector<Index> root_;
};

/// What was made of cubes, one after the other.
struct Cubes {
  using Index = CutGrid::Index;
  using Triangle = std::array<Index, 3>;
  struct End {
    std::size_t vertex, joined, outer, wall;
  };

  std::vector<Index> cube;    ///< ascending
  std::vector<End> end;       ///< of what belongs to each cube, in the lists below
  std::vector<Index> vertex;  ///< in the order in which they were come across
  std::vector<std::array<Index, 2>> joined;
  std::vector<Triangle> outer, wall;

  void close(Index of) { cube.push_back(of), end.push_back({vertex.size(), joined.size(), outer.size(), wall.size()}); }
  void copy(const Cubes& from, std::size_t n) {
    const End first = n > 0 ? from.end[n - 1] : End{}, last = from.end[n];
    const auto append = [](auto& to, const auto& list, std::size_t a, std::size_t b) {
      to.insert(to.end(), list.begin() + std::ptrdiff_t(a), list.begin() + std::ptrdiff_t(b));
    };
    append(vertex, from.vertex, first.vertex, last.vertex), append(joined, from.joined, first.joined, last.joined);
    append(outer, from.outer, first.outer, last.outer), append(wall, from.wall, first.wall, last.wall);
    close(from.cube[n]);
  }
  void clear() { cube.clear(), end.clear(), vertex.clear(), joined.clear(), outer.clear(), wall.clear(); }
};

}  // namespace ctpm::cutbody
