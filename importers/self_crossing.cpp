#include "importers/self_crossing.h"

#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <mutex>
#include <optional>
#include <utility>

#include "core/model/box.h"
#include "importers/cgal_mesh.h"
#include "importers/in_pieces.h"
#include "importers/mesh_surgery.h"

namespace ctpm::importers {
namespace {

constexpr int kMostRings = 4;  // rings around the crossing triangles that may be removed too

constexpr double kMostChange = 0.02;  // largest relative change of volume

/// Also selects all triangles that touch a selected one.
void grow(const Soup& soup, std::vector<char>& is_cut) {
  std::vector<char> is_touched(soup.vertex.size(), 0);
  for (std::size_t t = 0; t < soup.triangle.size(); ++t)
    for (const std::int32_t v : soup.triangle[t])
      if (is_cut[t]) is_touched[std::size_t(v)] = 1;
  for (std::size_t t = 0; t < soup.triangle.size(); ++t)
    for (const std::int32_t v : soup.triangle[t])
      if (is_touched[std::size_t(v)]) is_cut[t] = 1;
}

Soup without(const Soup& soup, const std::vector<char>& is_cut) {
  Soup rest{soup.vertex, {}};
  for (std::size_t t = 0; t < soup.triangle.size(); ++t)
    if (!is_cut[t]) rest.triangle.push_back(soup.triangle[t]);
  return rest;
}

/// The mesh without the selected triangles. Selects more where the rest would be joined only at a vertex.
std::optional<Soup> cut_out(const Soup& soup, std::vector<char>& is_cut) {
  constexpr int kMostRounds = 20;
  for (int round = 0; round < kMostRounds; ++round) {
    Soup rest = without(soup, is_cut);
    if (rest.triangle.empty()) return {};
    std::vector<char> is_pinched(soup.vertex.size(), 0);
    const std::vector<std::int32_t> pinched = find_pinched(rest);
    if (pinched.empty()) return rest;
    for (const std::int32_t v : pinched) is_pinched[std::size_t(v)] = 1;
    for (std::size_t t = 0; t < soup.triangle.size(); ++t)
      for (const std::int32_t v : soup.triangle[t])
        if (is_pinched[std::size_t(v)]) is_cut[t] = 1;
  }
  return {};
}

/// Euler number of a closed mesh, V - E + F over the used vertices: 2 for a ball, 0 for a torus.
std::int64_t euler_number(const Soup& soup) {
  std::vector<char> is_used(soup.vertex.size(), 0);
  for (const Triangle& t : soup.triangle)
    for (const std::int32_t v : t) is_used[std::size_t(v)] = 1;
  return std::count(is_used.begin(), is_used.end(), 1) - std::int64_t(soup.triangle.size()) / 2;
}

using Corners = std::array<Vec3, 3>;

Corners corners_of(const Soup& soup, std::size_t t) {
  const auto at = [&](std::size_t c) { return soup.vertex[std::size_t(soup.triangle[t][c])]; };
  return {at(0), at(1), at(2)};
}

cgal::Point to_cgal(Vec3 p) { return {p.x, p.y, p.z}; }

bool is_collinear(const Corners& p) { return CGAL::collinear(to_cgal(p[0]), to_cgal(p[1]), to_cgal(p[2])); }

/// Whether rounded numbers show already that the corners of `b` from `first` on lie on one side of the plane of `a`.
bool are_beside(const Corners& a, const Corners& b, std::size_t first) {
  // Of the largest coordinate cubed; the determinant is off by half of that at most.
  constexpr double kRounding = 1e-14;
  const Vec3 u = a[1] - a[0], v = a[2] - a[0], normal = cross(u, v);
  const auto size = [](Vec3 p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); };
  const double plane = std::max(size(u), size(v));
  bool is_above = true, is_below = true;
  for (std::size_t c = first; c < 3; ++c) {
    const Vec3 w = b[c] - a[0];
    const double height = dot(normal, w), most = std::max(plane, size(w)), off = kRounding * most * most * most;
    is_above = is_above && height > off, is_below = is_below && height < -off;
  }
  return is_above || is_below;
}

/// Whether two triangles have more in common than a corner or an edge of both. Triangles at a split corner or edge have
/// common positions but no common vertices, so positions decide.
bool do_cross(Corners a, Corners b) {
  // Move the common corners to the front, in the same order.
  std::size_t common = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (const auto it = std::find(b.begin() + std::ptrdiff_t(common), b.end(), a[i]); it != b.end()) {
      std::swap(a[i], a[common]);
      std::iter_swap(it, b.begin() + std::ptrdiff_t(common));
      ++common;
    }
  if (common == 3) return true;
  if (are_beside(a, b, common) || are_beside(b, a, common)) return false;
  using Segment = cgal::Kernel::Segment_3;
  using Face = cgal::Kernel::Triangle_3;
  const std::array<cgal::Point, 3> p{to_cgal(a[0]), to_cgal(a[1]), to_cgal(a[2])},
      q{to_cgal(b[0]), to_cgal(b[1]), to_cgal(b[2])};
  if (common == 2)
    return CGAL::coplanar(p[0], p[1], p[2], q[2]) &&
           CGAL::coplanar_orientation(p[0], p[1], p[2], q[2]) != CGAL::NEGATIVE;
  const Face one(p[0], p[1], p[2]), other(q[0], q[1], q[2]);
  if (common == 0) return CGAL::do_intersect(one, other);
  return CGAL::do_intersect(one, Segment(q[1], q[2])) || CGAL::do_intersect(other, Segment(p[1], p[2]));
}

/// Triangles along a curve that fills space, in a tree of boxes: each holds kFan that follow each other on the level
/// below it, and the lowest those of kFan triangles.
class BoxTree {
 public:
  static constexpr std::size_t kFan = 8;

  BoxTree(const Soup& soup, const std::vector<std::int32_t>& triangles) {
    struct Key {
      std::uint64_t code;
      std::int32_t triangle;
    };
    const BoundingBox all = bounding_box(soup);
    const Vec3 size = all.most - all.least;
    const double scale = double(kMostCode) / std::max({size.x, size.y, size.z});
    std::vector<Key> keys;
    keys.reserve(triangles.size());
    for (const std::int32_t t : triangles) {
      const Corners p = corners_of(soup, std::size_t(t));
      const Vec3 at = scale * ((p[0] + p[1] + p[2]) / 3 - all.least);
      keys.push_back({code_of(at.x) | code_of(at.y) << 1 | code_of(at.z) << 2, t});
    }
    std::sort(keys.begin(), keys.end(),
              [](const Key& a, const Key& b) { return a.code != b.code ? a.code < b.code : a.triangle < b.triangle; });
    levels_.emplace_back().reserve(keys.size());
    for (const Key& key : keys) {
      const Corners p = corners_of(soup, std::size_t(key.triangle));
      order_.push_back(key.triangle), levels_[0].emplace_back(p[0], p[1], p[2]);
    }
    while (levels_.back().size() > kFan) {
      std::vector<Box> above;
      const std::vector<Box>& below = levels_.back();
      for (std::size_t n = 0; n < below.size(); ++n) {
        if (n % kFan == 0) above.push_back(below[n]);
        above.back().add(below[n].low), above.back().add(below[n].high);
      }
      levels_.push_back(std::move(above));
    }
  }

  std::size_t size() const { return order_.size(); }

  /// Calls `visit(a, b)` once for each two triangles whose boxes meet, of which the first along the curve is in
  /// [begin, end), whole multiples of kFan or the end.
  template <class Visit>
  void for_each_meeting(std::size_t begin, std::size_t end, const Visit& visit) const {
    if (levels_.size() == 1) {
      compare(0, size(), 0, size(), visit);
      return;
    }
    for (std::size_t run = begin; run < end; run += kFan) {
      const Box& own = levels_[1][run / kFan];
      for (std::size_t n = 0; n < levels_.back().size(); ++n)
        descend(levels_.size() - 1, n, own, [&](std::size_t other) {
          if (other >= run) compare(run, std::min(run + kFan, size()), other, std::min(other + kFan, size()), visit);
        });
    }
  }

 private:
  static constexpr std::uint64_t kMostCode = (1u << 21) - 1;

  /// A coordinate's bits, each followed by two others.
  static std::uint64_t code_of(double coordinate) {
    auto n = std::min(std::uint64_t(std::max(coordinate, 0.0)), kMostCode);
    n = (n | n << 32) & 0x001f00000000ffffu;
    n = (n | n << 16) & 0x001f0000ff0000ffu;
    n = (n | n << 8) & 0x100f00f00f00f00fu;
    n = (n | n << 4) & 0x10c30c30c30c30c3u;
    return (n | n << 2) & 0x1249249249249249u;
  }

  /// Calls `on_run(first)` for the lowest boxes in box `n` of a level that meet another one.
  template <class OnRun>
  void descend(std::size_t level, std::size_t n, const Box& own, const OnRun& on_run) const {
    if (!levels_[level][n].meets(own)) return;
    if (level == 1) return on_run(kFan * n);
    const std::size_t last = std::min(kFan * (n + 1), levels_[level - 1].size());
    for (std::size_t child = kFan * n; child < last; ++child) descend(level - 1, child, own, on_run);
  }

  template <class Visit>
  void compare(std::size_t a, std::size_t a_end, std::size_t b, std::size_t b_end, const Visit& visit) const {
    for (std::size_t i = a; i < a_end; ++i)
      for (std::size_t j = std::max(b, i + 1); j < b_end; ++j)
        if (levels_[0][i].meets(levels_[0][j])) visit(order_[i], order_[j]);
  }

  std::vector<std::int32_t> order_;       ///< triangles along the curve
  std::vector<std::vector<Box>> levels_;  ///< of the triangles, and of kFan of the level below [m]
};

double volume_of(const Soup& soup) { return signed_volume(soup.vertex, soup.triangle, bounding_box(soup).centre()); }

bool is_as_good(const Soup& mended, const Soup& soup) {
  const MeshCounts counts = count_mesh(mended.vertex, mended.triangle);
  return counts.open_edges == 0 && counts.non_manifold_edges == 0 && counts.parts == 1 &&
         euler_number(mended) == euler_number(soup) && std::abs(volume_of(mended) / volume_of(soup) - 1) <= kMostChange;
}

}  // namespace

std::vector<std::int32_t> find_crossing(const Soup& soup, int threads) {
  std::vector<std::int32_t> crossing, others;
  for (std::size_t t = 0; t < soup.triangle.size(); ++t)
    (is_collinear(corners_of(soup, t)) ? crossing : others).push_back(std::int32_t(t));
  const BoxTree tree(soup, others);
  std::mutex mutex;
  in_pieces(tree.size(), threads, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> found;
    tree.for_each_meeting(begin, end, [&](std::int32_t a, std::int32_t b) {
      if (do_cross(corners_of(soup, std::size_t(a)), corners_of(soup, std::size_t(b))))
        found.push_back(a), found.push_back(b);
    });
    const std::lock_guard lock(mutex);
    crossing.insert(crossing.end(), found.begin(), found.end());
  });
  std::sort(crossing.begin(), crossing.end());
  crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
  return crossing;
}

std::int64_t cut_crossing(Soup& soup, const std::vector<std::int32_t>& crossing, double largest_hole) {
  std::vector<char> is_cut(soup.triangle.size(), 0);
  for (const std::int32_t t : crossing) is_cut[std::size_t(t)] = 1;
  for (int ring = 0; ring <= kMostRings; ++ring) {
    if (ring > 0) grow(soup, is_cut);
    std::optional<Soup> mended = cut_out(soup, is_cut);
    if (!mended) return 0;
    const Closing closing = fill_holes(*mended, largest_hole);
    if (!closing.too_large.empty()) return 0;  // more rings only enlarge the hole
    if (!closing.unfillable.empty() || !is_as_good(*mended, soup) || !find_crossing(*mended).empty()) continue;
    soup = std::move(*mended);
    drop_unused(soup);
    return std::count(is_cut.begin(), is_cut.end(), 1);
  }
  return 0;
}

}  // namespace ctpm::importers
