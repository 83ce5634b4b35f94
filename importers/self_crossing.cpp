#include "importers/self_crossing.h"

#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "importers/cgal_mesh.h"
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

using Corners = std::array<cgal::Point, 3>;

Corners corners_of(const Soup& soup, std::size_t t) {
  const auto at = [&](std::size_t c) {
    const Vec3 p = soup.vertex[std::size_t(soup.triangle[t][c])];
    return cgal::Point(p.x, p.y, p.z);
  };
  return {at(0), at(1), at(2)};
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
  using Segment = cgal::Kernel::Segment_3;
  using Face = cgal::Kernel::Triangle_3;
  const Face one(a[0], a[1], a[2]), other(b[0], b[1], b[2]);
  if (common == 0) return CGAL::do_intersect(one, other);
  if (common == 1)
    return CGAL::do_intersect(one, Segment(b[1], b[2])) || CGAL::do_intersect(other, Segment(a[1], a[2]));
  if (common == 2)
    return CGAL::coplanar(a[0], a[1], a[2], b[2]) &&
           CGAL::coplanar_orientation(a[0], a[1], a[2], b[2]) != CGAL::NEGATIVE;
  return true;
}

double volume_of(const Soup& soup) { return signed_volume(soup.vertex, soup.triangle, bounding_box(soup).centre()); }

bool is_as_good(const Soup& mended, const Soup& soup) {
  const MeshCounts counts = count_mesh(mended.vertex, mended.triangle);
  return counts.open_edges == 0 && counts.non_manifold_edges == 0 && counts.parts == 1 &&
         euler_number(mended) == euler_number(soup) && std::abs(volume_of(mended) / volume_of(soup) - 1) <= kMostChange;
}

}  // namespace

std::vector<std::int32_t> find_crossing(const Soup& soup) {
  using Box =
      CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::int32_t, CGAL::Box_intersection_d::ID_FROM_BOX_ADDRESS>;
  std::vector<std::int32_t> crossing;
  std::vector<Box> boxes;
  boxes.reserve(soup.triangle.size());
  for (std::size_t t = 0; t < soup.triangle.size(); ++t) {
    const Corners p = corners_of(soup, t);
    if (CGAL::collinear(p[0], p[1], p[2]))
      crossing.push_back(std::int32_t(t));
    else
      boxes.emplace_back(p[0].bbox() + p[1].bbox() + p[2].bbox(), std::int32_t(t));
  }
  std::vector<const Box*> order;
  order.reserve(boxes.size());
  for (const Box& box : boxes) order.push_back(&box);
  constexpr std::ptrdiff_t kCutoff = 2000;  // boxes that are compared without a tree
  CGAL::box_self_intersection_d(
      order.begin(), order.end(),
      [&](const Box* one, const Box* other) {
        const auto a = std::size_t(one->info()), b = std::size_t(other->info());
        if (do_cross(corners_of(soup, a), corners_of(soup, b)))
          crossing.push_back(std::int32_t(a)), crossing.push_back(std::int32_t(b));
      },
      kCutoff);
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
