#include "core/surface/near_surface.h"

#include <algorithm>
#include <cmath>

namespace ctpm::surface {
namespace {

constexpr NearSurface::Index kTrianglesPerPatch = 32, kPatchesPerGroup = 8;

/// Bindings put a vertex at its place at rest only up to rounding and regularisation [m].
constexpr double kRounding = 1e-4;

/// Spreads the low 10 bits of a number to every third bit.
std::uint32_t spread_bits(std::uint32_t n) {
  n = (n | n << 16) & 0x030000ff;
  n = (n | n << 8) & 0x0300f00f;
  n = (n | n << 4) & 0x030c30c3;
  return (n | n << 2) & 0x09249249;
}

}  // namespace

NearSurface::NearSurface(const Model& model, std::size_t first_organ, std::size_t last_organ)
    : sphere_rest_(model.rest_position),
      first_of_all_(first_organ < last_organ ? std::size_t(model.organs[first_organ].first) : 0),
      last_of_all_(first_organ < last_organ
                       ? std::size_t(model.organs[last_organ - 1].first + model.organs[last_organ - 1].count)
                       : 0) {
  first_.push_back(0);
  for (std::size_t i = first_organ; i < last_organ; ++i) add_organ(model.surfaces[i], model.organs[i]);
  if (triangles_.empty()) return;
  sort_triangles();
  const auto count = Index(triangles_.size());
  for (Index t = 0; t < count; t += kTrianglesPerPatch) {
    const Index last = std::min(t + kTrianglesPerPatch, count);
    patches_.push_back(bound_of(t, last, t, last));
  }
  const auto patches = Index(patches_.size());
  for (Index p = 0; p < patches; p += kPatchesPerGroup) {
    const Index last = std::min(p + kPatchesPerGroup, patches);
    groups_.push_back(bound_of(p, last, patches_[std::size_t(p)].first, patches_[std::size_t(last) - 1].last));
  }
  placed_.resize(vertex_count()), placed_in_.assign(vertex_count(), 0);
}

void NearSurface::add_organ(const Surface& surface, const OrganRange& organ) {
  const auto first_vertex = Index(vertex_count()), first_entry = Index(sphere_.size());
  if (surface.vertex.empty()) return;
  rest_.insert(rest_.end(), surface.vertex.begin(), surface.vertex.end());
  for (std::size_t v = 1; v < surface.binding.first.size(); ++v)
    first_.push_back(first_entry + surface.binding.first[v]);
  for (const Index sphere : surface.binding.sphere) sphere_.push_back(organ.first + sphere);
  weight_.insert(weight_.end(), surface.binding.weight.begin(), surface.binding.weight.end());
  for (const auto& corner : surface.triangle) {
    Triangle triangle{{first_vertex + corner[0], first_vertex + corner[1], first_vertex + corner[2]}, 0, 0};
    const Vec3 a = surface.vertex[std::size_t(corner[0])], b = surface.vertex[std::size_t(corner[1])],
               c = surface.vertex[std::size_t(corner[2])];
    triangle.rest_area = 0.5 * norm(cross(b - a, c - a));
    triangle.longest_edge = std::max({norm(b - a), norm(c - b), norm(a - c)});
    triangles_.push_back(triangle);
  }
}

/// Sorts the triangles along a Morton curve, so that runs of them are compact.
void NearSurface::sort_triangles() {
  Box box(rest_.front());
  for (const Vec3& p : rest_) box.add(p);
  const Vec3 span = box.high - box.low;
  const double size = std::max({span.x, span.y, span.z});
  const double scale = size > 0 ? 1023 / size : 0;
  struct Key {
    std::uint32_t code;
    Index triangle;
  };
  std::vector<Key> keys;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Vec3 p = rest(triangles_[t].corner[0]) - box.low;
    const auto part = [&](double x) { return spread_bits(std::uint32_t(x * scale)); };
    keys.push_back({part(p.x) | part(p.y) << 1 | part(p.z) << 2, Index(t)});
  }
  std::sort(keys.begin(), keys.end(),
            [](const Key& p, const Key& q) { return p.code != q.code ? p.code < q.code : p.triangle < q.triangle; });
  std::vector<Triangle> sorted;
  for (const Key& key : keys) sorted.push_back(triangles_[std::size_t(key.triangle)]);
  triangles_ = std::move(sorted);
}

NearSurface::Bound NearSurface::bound_of(Index first, Index last, Index first_triangle, Index last_triangle) {
  std::vector<Index> spheres;
  double widen = 0;
  Box box(rest(triangles_[std::size_t(first_triangle)].corner[0]));
  for (Index t = first_triangle; t < last_triangle; ++t)
    for (const Index corner : triangles_[std::size_t(t)].corner) {
      const Follower follows = follower(corner);
      box.add(rest(corner));
      spheres.insert(spheres.end(), follows.sphere.begin(), follows.sphere.end());
      double negative = 0;
      for (const double w : follows.weight) negative -= std::min(w, 0.0);
      widen = std::max(widen, negative);
    }
  std::sort(spheres.begin(), spheres.end());
  spheres.erase(std::unique(spheres.begin(), spheres.end()), spheres.end());
  const auto begin = Index(bound_spheres_.size());
  bound_spheres_.insert(bound_spheres_.end(), spheres.begin(), spheres.end());
  return {first, last, begin, Index(bound_spheres_.size()), box, widen};
}

/// Range of a bound along one axis, from its spheres' coordinates `values` and its own range at rest.
NearSurface::Range NearSurface::range_along(const Bound& bound, const std::vector<double>& values,
                                            const std::vector<double>& rest, double low, double high) const {
  const auto moved = [&](Index s) {
    const auto sphere = std::size_t(bound_spheres_[std::size_t(s)]);
    return values[sphere] - rest[sphere];
  };
  double least = moved(bound.first_sphere), most = least;
  for (Index s = bound.first_sphere + 1; s < bound.last_sphere; ++s) {
    const double by = moved(s);
    least = std::min(least, by), most = std::max(most, by);
  }
  const double margin = bound.widen * (most - least) + kRounding;
  return {low + least - margin, high + most + margin};
}

Box NearSurface::box_of(const Bound& bound, const Vec3Array& position) const {
  const Box& rest = bound.rest;
  const Range x = range_along(bound, position.x, sphere_rest_.x, rest.low.x, rest.high.x),
              y = range_along(bound, position.y, sphere_rest_.y, rest.low.y, rest.high.y),
              z = range_along(bound, position.z, sphere_rest_.z, rest.low.z, rest.high.z);
  return Box(Vec3{x.low, y.low, z.low}, Vec3{x.high, y.high, z.high});
}

Box NearSurface::displacements(const Vec3Array& position) const {
  const auto along = [&](const std::vector<double>& values, const std::vector<double>& rest) {
    double least = values[first_of_all_] - rest[first_of_all_], most = least;
    for (std::size_t i = first_of_all_ + 1; i < last_of_all_; ++i) {
      const double by = values[i] - rest[i];
      least = std::min(least, by), most = std::max(most, by);
    }
    return Range{least, most};
  };
  const Range x = along(position.x, sphere_rest_.x), y = along(position.y, sphere_rest_.y),
              z = along(position.z, sphere_rest_.z);
  return Box(Vec3{x.low, y.low, z.low}, Vec3{x.high, y.high, z.high});
}

Box NearSurface::rough_box_of(const Bound& bound, const Box& moved) const {
  const Vec3 range = moved.high - moved.low, rounding{kRounding, kRounding, kRounding};
  return Box(bound.rest.low + moved.low - bound.widen * range - rounding,
             bound.rest.high + moved.high + bound.widen * range + rounding);
}

/// As box_of(), but stops at the first axis that parts them.
bool NearSurface::is_near(const Bound& bound, const Vec3Array& position, const Box& region) const {
  const auto is_near_along = [&](const std::vector<double>& values, const std::vector<double>& rest, double low,
                                 double high, double region_low, double region_high) {
    const Range range = range_along(bound, values, rest, low, high);
    return region_high >= range.low && region_low <= range.high;
  };
  const Box& rest = bound.rest;
  return is_near_along(position.x, sphere_rest_.x, rest.low.x, rest.high.x, region.low.x, region.high.x) &&
         is_near_along(position.y, sphere_rest_.y, rest.low.y, rest.high.y, region.low.y, region.high.y) &&
         is_near_along(position.z, sphere_rest_.z, rest.low.z, rest.high.z, region.low.z, region.high.z);
}

Vec3 NearSurface::place(Index vertex, const Vec3Array& position) {
  const auto v = std::size_t(vertex);
  if (placed_in_[v] != round_) placed_in_[v] = round_, placed_[v] = follower(vertex).of(position);
  return placed_[v];
}

}  // namespace ctpm::surface
