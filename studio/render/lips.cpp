#include "studio/render/lips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace ctpm::render {
namespace {

using Ends = std::array<std::int32_t, 2>;  // of an edge, the smaller first

double distance_to(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 along = b - a;
  const double square = dot(along, along);
  const double t = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
  return norm(p - a - t * along);
}

/// The edges of the cut: those between two of its vertices that only one triangle of the outer surface has.
std::vector<Ends> edges_of_cut(const Surface& surface, const std::vector<std::uint8_t>& is_lip) {
  std::map<Ends, int> count;
  const auto is_on = [&](std::int32_t v) { return std::size_t(v) < is_lip.size() && is_lip[std::size_t(v)]; };
  for (const auto& t : surface.triangle) {
    if (std::size_t(t[0]) >= is_lip.size()) continue;  // the wall's
    for (std::size_t i = 0; i < 3; ++i)
      if (const std::int32_t a = t[i], b = t[(i + 1) % 3]; is_on(a) && is_on(b))
        ++count[{std::min(a, b), std::max(a, b)}];
  }
  std::vector<Ends> edges;
  for (const auto& [ends, triangles] : count)
    if (triangles == 1) edges.push_back(ends);
  return edges;
}

}  // namespace

std::vector<float> nearness_to_lips(const Surface& surface, const std::vector<std::uint8_t>& is_lip, double reach) {
  std::vector<float> nearness(surface.vertex.size(), 0.0f);
  const std::vector<Ends> edges = edges_of_cut(surface, is_lip);
  if (edges.empty()) return nearness;
  constexpr std::size_t kNone = std::size_t(-1);
  std::vector<std::size_t> nearest(is_lip.size(), kNone);
  std::vector<double> distance(is_lip.size(), kLipsKnown * reach);
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const std::int32_t v : edges[e]) nearest[std::size_t(v)] = e, distance[std::size_t(v)] = 0;
  // What is nearest to a vertex is near to its neighbours; slivers lie in a row beside the edge.
  constexpr int kMostRounds = 8;
  bool changes = true;
  for (int round = 0; round < kMostRounds && changes; ++round) {
    changes = false;
    for (const auto& t : surface.triangle) {
      if (std::size_t(t[0]) >= is_lip.size()) continue;
      for (std::size_t i = 0; i < 6; ++i) {
        const auto from = std::size_t(t[i % 3]), to = std::size_t(t[(i + 1 + i / 3) % 3]);
        if (nearest[from] == kNone || nearest[from] == nearest[to] || distance[to] == 0) continue;
        const auto& [a, b] = edges[nearest[from]];
        const double here =
            distance_to(surface.vertex[to], surface.vertex[std::size_t(a)], surface.vertex[std::size_t(b)]);
        if (here < distance[to]) distance[to] = here, nearest[to] = nearest[from], changes = true;
      }
    }
  }
  for (std::size_t v = 0; v < is_lip.size(); ++v) nearness[v] = float(1 - distance[v] / reach);
  return nearness;
}

}  // namespace ctpm::render
