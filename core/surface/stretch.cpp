#include "core/surface/stretch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>

#include "core/model/box.h"

namespace ctpm::surface {
namespace {

/// How far around stretched triangles places may move, at rest, in spacings.
constexpr double kAround = 2;
/// Sweeps over the edges at most: some ten are needed where a flap folds over.
constexpr int kMostSweeps = 200;
/// An edge is short enough if it is longer than it may be by this part only.
constexpr double kSlack = 1e-3;

using Triangle = std::array<std::int32_t, 3>;

double longest_edge(Vec3 a, Vec3 b, Vec3 c) { return std::max({norm(b - a), norm(c - b), norm(a - c)}); }

double longest_edge(const std::vector<Vec3>& vertex, const Triangle& t) {
  return longest_edge(vertex[std::size_t(t[0])], vertex[std::size_t(t[1])], vertex[std::size_t(t[2])]);
}

/// The length that edges of a triangle may have [m].
double most_length(const Surface& surface, const Triangle& t, double spacing) {
  return kMostStretch * std::max(longest_edge(surface.vertex, t), kShort * spacing);
}

/// Around all triangles that are too long; none: no triangle is.
std::optional<Box> find_stretched(const Surface& surface, double spacing, const std::vector<Vec3>& vertex) {
  std::optional<Box> around;
  const double least = kMostStretch * kShort * spacing;
  for (const Triangle& t : surface.triangle) {
    const double longest = longest_edge(vertex, t);
    if (longest <= least || longest <= most_length(surface, t, spacing)) continue;
    for (const std::int32_t v : t) {
      const Vec3 rest = surface.vertex[std::size_t(v)];
      around ? around->add(rest) : void(around.emplace(rest));
    }
  }
  return around;
}

/// The triangles around stretched ones, between places that may move and such that may not.
class Spreading {
 public:
  Spreading(const Surface& surface, double spacing, const Box& around, const std::vector<Vec3>& vertex)
      : place_of_(surface.vertex.size(), -1) {
    const auto may_move = [&](std::int32_t v) { return around.meets(Box(surface.vertex[std::size_t(v)])); };
    std::vector<std::int32_t> corners;
    for (const Triangle& t : surface.triangle) {
      if (std::none_of(t.begin(), t.end(), may_move)) continue;
      triangle_.push_back(t), most_.push_back(most_length(surface, t, spacing));
      corners.insert(corners.end(), t.begin(), t.end());
    }
    // Vertices that are together are one place.
    const auto key = [&](std::int32_t v) {
      const Vec3 p = surface.vertex[std::size_t(v)], q = vertex[std::size_t(v)];
      return std::tuple(p.x, p.y, p.z, q.x, q.y, q.z);
    };
    std::sort(corners.begin(), corners.end(),
              [&](auto a, auto b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::int32_t v = corners[i];
      if (i == 0 || key(corners[i - 1]) != key(v))
        place_.push_back(vertex[std::size_t(v)]), moves_.push_back(may_move(v) ? 1 : 0);
      place_of_[std::size_t(v)] = std::int32_t(place_.size()) - 1;
    }
    for (Triangle& t : triangle_)
      for (std::int32_t& v : t) v = place_of_[std::size_t(v)];
  }

  /// Shortens each edge that is too long, both of its ends by the same. Returns whether one was.
  bool sweep() {
    bool was_long = false;
    for (std::size_t t = 0; t < triangle_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const auto a = std::size_t(triangle_[t][c]), b = std::size_t(triangle_[t][(c + 1) % 3]);
        const Vec3 edge = place_[b] - place_[a];
        const double length = norm(edge), shares = moves_[a] + moves_[b];
        if (length <= (1 + kSlack) * most_[t] || shares == 0) continue;
        const Vec3 by = (1 - most_[t] / length) / shares * edge;
        place_[a] += moves_[a] * by, place_[b] += -moves_[b] * by;
        was_long = true;
      }
    return was_long;
  }

  void put(std::vector<Vec3>& vertex) const {
    for (std::size_t v = 0; v < vertex.size(); ++v)
      if (place_of_[v] >= 0) vertex[v] = place_[std::size_t(place_of_[v])];
  }

 private:
  std::vector<std::int32_t> place_of_;  ///< of each vertex; -1: it is not among the triangles (vertex_count)
  std::vector<Vec3> place_;             ///< [m]
  std::vector<double> moves_;           ///< 1: it may; 0: it stays
  std::vector<Triangle> triangle_;      ///< between places
  std::vector<double> most_;            ///< length that edges of each triangle may have [m]
};

}  // namespace

double stretch_of(const Vec3 (&rest)[3], const Vec3 (&now)[3], double spacing) {
  return longest_edge(now[0], now[1], now[2]) / std::max(longest_edge(rest[0], rest[1], rest[2]), kShort * spacing);
}

void spread_stretch(const Surface& surface, double spacing, std::vector<Vec3>& vertex) {
  const std::optional<Box> stretched = find_stretched(surface, spacing, vertex);
  if (!stretched) return;
  Spreading spreading(surface, spacing, stretched->grown(kAround * spacing), vertex);
  for (int i = 0; i < kMostSweeps && spreading.sweep(); ++i) continue;
  spreading.put(vertex);
}

}  // namespace ctpm::surface
