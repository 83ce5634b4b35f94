// What the nodes of a cut organ's grid see of each other.

#include "core/cutbody/sight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/cutting/swept_surface.h"
#include "tests/core/blade_blocks.h"
#include "tests/core/skinned_block.h"

namespace ctpm {
namespace {

using cutbody::CutGrid;
using cutbody::Sight;
using Index = CutGrid::Index;

/// Edges of the shortest way to each node in tissue, found from neighbour to neighbour; -1: it is more than are seen.
std::vector<Index> ways_from(const CutGrid& grid, Index node) {
  std::vector<Index> way(std::size_t(grid.count()), -1), reached{node};
  way[std::size_t(node)] = 0;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const Index from = reached[next];
    if (way[std::size_t(from)] == Sight::kMostHops) break;
    const CutGrid::Node n = grid.node(from);
    for (int d = 1; d < CutGrid::kDirections; ++d)
      for (const int sign : {1, -1}) {
        const CutGrid::Node to{n[0] + sign * (d & 1), n[1] + sign * (d >> 1 & 1), n[2] + sign * (d >> 2)};
        if (!grid.contains(to) || !grid.in_tissue(grid.at(to)) || way[std::size_t(grid.at(to))] >= 0) continue;
        if (grid.is_parted(sign > 0 ? from : grid.at(to), d)) continue;
        way[std::size_t(grid.at(to))] = way[std::size_t(from)] + 1, reached.push_back(grid.at(to));
      }
  }
  return way;
}

bool is_at_cut(const CutGrid& grid, Index node) {
  const CutGrid::Node n = grid.node(node);
  for (int d = 1; d < CutGrid::kDirections; ++d) {
    const CutGrid::Node up{n[0] + (d & 1), n[1] + (d >> 1 & 1), n[2] + (d >> 2)},
        down{n[0] - (d & 1), n[1] - (d >> 1 & 1), n[2] - (d >> 2)};
    if ((grid.contains(up) && grid.is_severed(node, d)) || (grid.contains(down) && grid.is_severed(grid.at(down), d)))
      return true;
  }
  return false;
}

struct Seen {
  struct Sphere {
    Index sphere, detour;
    friend bool operator==(const Sphere&, const Sphere&) = default;
  };
  std::vector<Sphere> sphere;  // ascending
  bool has_cut = false;
  friend bool operator==(const Seen&, const Seen&) = default;
};

Seen seen_from(Sight& sight, const CutGrid& grid, Index node) {
  Seen seen{{}, sight.has_cut(node)};
  for (Index s = 0; s < grid.sphere_count(); ++s) {
    const Sight::View* view = sight.view_of(s);
    if (const Index detour = view == nullptr ? -1 : view->detour(grid.node(node)); detour >= 0)
      seen.sphere.push_back({s, detour});
  }
  return seen;
}

/// The same as Sight finds, node by node.
Seen seen_from(const CutGrid& grid, Index node) {
  const std::vector<Index> way = ways_from(grid, node);
  const CutGrid::Node home = grid.node(node);
  Seen seen;
  for (Index i = 0; i < grid.count(); ++i)
    seen.has_cut =
        seen.has_cut || (way[std::size_t(i)] >= 0 && way[std::size_t(i)] < Sight::kMostHops && is_at_cut(grid, i));
  for (Index sphere = 0; sphere < grid.sphere_count(); ++sphere) {
    const Index i = grid.node_of_sphere(sphere);
    if (i < 0 || way[std::size_t(i)] < 0) continue;
    Index up = 0, down = 0;
    for (std::size_t a = 0; a < 3; ++a)
      up = std::max(up, grid.node(i)[a] - home[a]), down = std::max(down, home[a] - grid.node(i)[a]);
    const Index detour = std::max(0, way[std::size_t(i)] - up - down - Sight::kGrazed);
    if (detour <= Sight::kMostDetour) seen.sphere.push_back({sphere, detour});
  }
  return seen;
}

/// Some nodes all over the tissue.
std::vector<Index> some_nodes(const CutGrid& grid) {
  std::vector<Index> nodes;
  for (Index i = 0; i < grid.count(); i += 3)
    if (grid.in_tissue(i)) nodes.push_back(i);
  return nodes;
}

/// Of some nodes, the number that see anything else than they should.
std::ptrdiff_t count_wrong(Sight& sight, const CutGrid& grid) {
  const std::vector<Index> nodes = some_nodes(grid);
  return std::count_if(nodes.begin(), nodes.end(),
                       [&](Index i) { return !(seen_from(sight, grid, i) == seen_from(grid, i)); });
}

TEST(Sight, NodesSeeWhatIsJoinedToThemWhileACutGrows) {
  const Model model = testing::make_skinned_block(7, 5, 5, network::Structure::ctpm, 0.003);
  CutGrid grid(model, 0);
  Sight sight(grid);
  EXPECT_EQ(count_wrong(sight, grid), 0) << "before a cut";
  State state = rest_state(model);
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  const auto front = [](double y) { return testing::straight_front({0.0013, y, 0.011}, {0.004, y, 0.06}); };
  (void)grid.take_changed();
  int changes = 0;
  for (int i = 0; i < 24; ++i) {
    cutting::add_swept(state, front(-0.05 + 0.004 * i), front(-0.05 + 0.004 * (i + 1)), newly);
    if (!grid.update(state)) continue;
    sight.update(grid.take_changed());
    if (++changes % 6 != 0) continue;
    EXPECT_EQ(count_wrong(sight, grid), 0) << "row " << i;
  }
  EXPECT_GT(changes, 6);
  EXPECT_TRUE(grid.anything_cut());
}

TEST(Sight, TellsWhichNodesSeeOtherwise) {
  const Model model = testing::make_skinned_block(7, 5, 5, network::Structure::ctpm, 0.003);
  CutGrid grid(model, 0);
  Sight sight(grid);
  State state = rest_state(model);
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  const auto front = [](double y) { return testing::straight_front({0.0013, y, 0.011}, {0.004, y, 0.06}); };
  const std::vector<Index> nodes = some_nodes(grid);
  std::vector<Seen> seen;
  for (const Index i : nodes) seen.push_back(seen_from(sight, grid, i));
  (void)grid.take_changed();
  std::size_t other = 0, told = 0, rounds = 0;
  for (int i = 0; i < 12; ++i) {
    cutting::add_swept(state, front(-0.05 + 0.004 * i), front(-0.05 + 0.004 * (i + 1)), newly);
    if (!grid.update(state)) continue;
    sight.update(grid.take_changed()), ++rounds;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      Seen now = seen_from(sight, grid, nodes[n]);
      const bool is_told = sight.changed_in(nodes[n]) == sight.round(), is_other = !(now == seen[n]);
      EXPECT_TRUE(is_told || !is_other) << "node " << nodes[n] << " in round " << rounds;
      other += is_other, told += is_told, seen[n] = std::move(now);
    }
  }
  EXPECT_GT(other, 0u);
  EXPECT_LT(told, 2 * other) << "hardly more than those that do";
  EXPECT_LT(told, rounds * nodes.size() / 2);
}

/// A cut may sever elements, or go on, without crossing another edge: the box of what changed is empty then.
TEST(Sight, AnEmptyBoxChangesNothingHoweverLargeTheOrgan) {
  const Model model = testing::make_skinned_block(5, 60, 5, network::Structure::ctpm, 0.003);
  CutGrid grid(model, 0);
  ASSERT_GT(grid.extent()[1], 4 * Sight::kMostHops);
  Sight sight(grid);
  State state = rest_state(model);
  cutting::NewlySwept newly;
  newly.fill(1), newly.back() = 0;
  const auto front = [](double y) { return testing::straight_front({0.0013, y, 0.011}, {0.004, y, 0.06}); };
  (void)grid.take_changed();
  cutting::add_swept(state, front(-0.05), front(0.05), newly);
  ASSERT_TRUE(grid.update(state));
  sight.update(grid.take_changed());
  const CutGrid::NodeBox nothing = grid.take_changed();
  EXPECT_TRUE(nothing.is_empty());
  sight.update(nothing);
  EXPECT_EQ(count_wrong(sight, grid), 0);
}

}  // namespace
}  // namespace ctpm
