#include "core/surface/near_surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace ctpm::surface {
namespace {

/// Bindings put a vertex at its place at rest only up to rounding and regularisation [m].
constexpr double kRounding = 1e-4;

/// Displacements of vertices whose spheres' displacements lie in `range` [m]; `widen`, `turned`: see
/// NearSurface::Bound.
Box widened(const Box& range, double widen, double turned) {
  const double more = kRounding + turned;
  const Vec3 margin = widen * (range.high - range.low) + Vec3{more, more, more};
  return Box(range.low - margin, range.high + margin);
}

/// 0 if they are the same, to the bit.
std::uint64_t different_bits(Vec3 a, Vec3 b) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return (bits(a.x) ^ bits(b.x)) | (bits(a.y) ^ bits(b.y)) | (bits(a.z) ^ bits(b.z));
}

/// Spreads the low 10 bits of a number to every third bit.
std::uint32_t spread_bits(std::uint32_t n) {
  n = (n | n << 16) & 0x030000ff;
  n = (n | n << 8) & 0x0300f00f;
  n = (n | n << 4) & 0x030c30c3;
  return (n | n << 2) & 0x09249249;
}

}  // namespace

NearSurface::NearSurface(const Model& model, std::size_t first_organ, std::size_t last_organ)
    : sphere_rest_(model.rest_position) {
  first_.push_back(0);
  const bool is_lent = last_organ == first_organ + 1 && model.organs[first_organ].first == 0;
  for (std::size_t i = first_organ; i < last_organ; ++i) {
    if (!is_lent) copy_followers(model.surfaces[i], model.organs[i]);
    add_organ(model.surfaces[i]);
    for (Index s = 0; s < model.organs[i].count; ++s) spheres_.push_back(model.organs[i].first + s);
  }
  if (is_lent) {
    const Surface& surface = model.surfaces[first_organ];
    rest_ = surface.vertex, sphere_ = surface.binding.sphere, weight_ = surface.binding.weight;
  } else {
    rest_ = own_rest_, sphere_ = own_sphere_, weight_ = own_weight_;
  }
  find_bounds(kTrianglesPerPatch);
}

NearSurface::NearSurface(const Model& model, std::size_t organ, const Surface& part)
    : sphere_rest_(model.rest_position) {
  first_.push_back(0);
  copy_followers(part, model.organs[organ]);
  add_organ(part), add_turned(part.binding, model.organs[organ]);
  rest_ = own_rest_, sphere_ = own_sphere_, weight_ = own_weight_;
  spheres_ = own_sphere_;
  for (const TissueFrame& frame : frame_) spheres_.insert(spheres_.end(), frame.sphere.begin(), frame.sphere.end());
  std::sort(spheres_.begin(), spheres_.end());
  spheres_.erase(std::unique(spheres_.begin(), spheres_.end()), spheres_.end());
  find_bounds(kTrianglesPerPatchOfPart);
}

void NearSurface::find_bounds(Index triangles_per_patch) {
  if (vertex_count() == 0) return;
  find_places_in_spheres();
  position_.resize(spheres_.size()), moved_.resize(spheres_.size());
  carried_.resize(vertex_count()), carried_in_.assign(vertex_count(), 0);
  if (!offset_size_.empty()) placed_.resize(vertex_count()), placed_in_.assign(vertex_count(), 0);
  if (triangles_.empty()) return;
  sort_triangles();
  negative_.assign(vertex_count(), 0);
  const auto count = Index(triangles_.size());
  std::vector<Index> seen(spheres_.size(), -1);
  for (Index t = 0; t < count; t += triangles_per_patch) {
    const Index last = std::min(t + triangles_per_patch, count);
    patches_.push_back(bound_of(t, last, t, last, seen));
  }
  const auto patches = Index(patches_.size());
  for (Index p = 0; p < patches; p += kPatchesPerGroup) {
    const Index last = std::min(p + kPatchesPerGroup, patches);
    groups_.push_back(bound_of(p, last, patches_[std::size_t(p)].first, patches_[std::size_t(last) - 1].last, seen));
  }
  patch_places_.resize(patches_.size()), group_places_.resize(groups_.size());
  rest_box_ = Box(rest_.front());
  for (const Vec3& p : rest_) rest_box_.add(p);
  for (const Bound& group : groups_)
    widen_ = std::max(widen_, group.widen), most_turned_ = std::max(most_turned_, group.turned);
}

void NearSurface::copy_followers(const Surface& surface, const OrganRange& organ) {
  own_rest_.insert(own_rest_.end(), surface.vertex.begin(), surface.vertex.end());
  own_sphere_.reserve(own_sphere_.size() + surface.binding.sphere.size());
  for (const Index sphere : surface.binding.sphere) own_sphere_.push_back(organ.first + sphere);
  own_weight_.insert(own_weight_.end(), surface.binding.weight.begin(), surface.binding.weight.end());
}

void NearSurface::add_organ(const Surface& surface) {
  const Index first_vertex = Index(vertex_count()), first_entry = first_.back();
  if (surface.vertex.empty()) return;
  first_.reserve(first_.size() + surface.vertex.size());
  triangles_.reserve(triangles_.size() + surface.triangle.size());
  for (std::size_t v = 1; v < surface.binding.first.size(); ++v)
    first_.push_back(first_entry + surface.binding.first[v]);
  for (const auto& corner : surface.triangle) {
    Triangle triangle{{first_vertex + corner[0], first_vertex + corner[1], first_vertex + corner[2]}, 0, 0};
    const Vec3 a = surface.vertex[std::size_t(corner[0])], b = surface.vertex[std::size_t(corner[1])],
               c = surface.vertex[std::size_t(corner[2])];
    triangle.rest_area = 0.5 * norm(cross(b - a, c - a));
    triangle.longest_edge = std::max({norm(b - a), norm(c - b), norm(a - c)});
    triangles_.push_back(triangle);
  }
}

void NearSurface::add_turned(const SurfaceBinding& binding, const OrganRange& organ) {
  if (binding.turned.empty()) return;
  turned_ = binding.turned, frame_ = binding.frame;
  for (TissueFrame& frame : frame_)
    for (Index& sphere : frame.sphere) sphere += organ.first;
  frame_turned_.resize(frame_.size());
  first_turned_.assign(vertex_count() + 1, 0);
  offset_size_.assign(vertex_count(), 0);
  for (const TurnedOffset& offset : turned_) {
    ++first_turned_[std::size_t(offset.vertex) + 1];
    offset_size_[std::size_t(offset.vertex)] += norm(offset.offset);
  }
  std::partial_sum(first_turned_.begin(), first_turned_.end(), first_turned_.begin());
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
  keys.reserve(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Vec3 p = rest(triangles_[t].corner[0]) - box.low;
    const auto part = [&](double x) { return spread_bits(std::uint32_t(x * scale)); };
    keys.push_back({part(p.x) | part(p.y) << 1 | part(p.z) << 2, Index(t)});
  }
  std::sort(keys.begin(), keys.end(),
            [](const Key& p, const Key& q) { return p.code != q.code ? p.code < q.code : p.triangle < q.triangle; });
  std::vector<Triangle> sorted;
  sorted.reserve(triangles_.size());
  for (const Key& key : keys) sorted.push_back(triangles_[std::size_t(key.triangle)]);
  triangles_ = std::move(sorted);
}

/// `seen`: of each of spheres_, the bound that listed it last.
NearSurface::Bound NearSurface::bound_of(Index first, Index last, Index first_triangle, Index last_triangle,
                                         std::vector<Index>& seen) {
  const auto begin = Index(bound_spheres_.size());
  double widen = 0, turned = 0;
  Box box(rest(triangles_[std::size_t(first_triangle)].corner[0]));
  for (Index t = first_triangle; t < last_triangle; ++t)
    for (const Index corner : triangles_[std::size_t(t)].corner) {
      box.add(rest(corner));
      double negative = 0;
      for (auto e = std::size_t(first_[std::size_t(corner)]); e < std::size_t(first_[std::size_t(corner) + 1]); ++e) {
        const Index sphere = in_spheres_[e];
        if (std::exchange(seen[std::size_t(sphere)], begin) != begin) bound_spheres_.push_back(sphere);
        negative -= std::min(weight_[e], 0.0);
      }
      negative_[std::size_t(corner)] = negative, widen = std::max(widen, negative);
      turned = std::max(turned, 2 * offset_size(corner));
    }
  std::sort(bound_spheres_.begin() + begin, bound_spheres_.end());
  return {first, last, begin, Index(bound_spheres_.size()), box, widen, turned};
}

/// Finds the places in spheres_ of what vertices follow.
void NearSurface::find_places_in_spheres() {
  in_spheres_ = sphere_;
  if (std::size_t(spheres_.back()) + 1 == spheres_.size()) return;  // their numbers
  std::vector<Index> place(std::size_t(spheres_.back() - spheres_.front()) + 1);
  for (std::size_t i = 0; i < spheres_.size(); ++i) place[std::size_t(spheres_[i] - spheres_.front())] = Index(i);
  const auto place_of = [&](Index sphere) { return place[std::size_t(sphere - spheres_.front())]; };
  own_in_spheres_.reserve(sphere_.size());
  for (const Index sphere : sphere_) own_in_spheres_.push_back(place_of(sphere));
  in_spheres_ = own_in_spheres_;
  for (TissueFrame& frame : frame_)
    for (Index& sphere : frame.sphere) sphere = place_of(sphere);
}

void NearSurface::begin(const Vec3Array& position) {
  constexpr std::size_t kRun = 32;  // spheres that are compared without a branch
  const std::size_t count = vertex_count() == 0 ? 0 : spheres_.size();
  std::size_t same = 0;
  for (std::uint64_t different = 0; same < count; same += kRun) {
    for (std::size_t i = same; i < std::min(same + kRun, count); ++i)
      different |= different_bits(position_[i], position[std::size_t(spheres_[i])]);
    if (different != 0) break;
  }
  // What was found while no sphere moved a bit is still so.
  if (same >= count && round_ > 0) return;
  ++round_;
  for (std::size_t i = same; i < count; ++i) position_[i] = position[std::size_t(spheres_[i])];
}

/// Finds how far the spheres have moved, once in a round.
void NearSurface::find_moved() const {
  if (std::exchange(moved_in_, round_) == round_ || empty()) return;
  for (std::size_t i = 0; i < spheres_.size(); ++i) moved_[i] = position_[i] - sphere_rest_[std::size_t(spheres_[i])];
  Box range(moved_.front());
  for (const Vec3& by : moved_) range.add(by);
  displacements_ = displacements_within(range);
}

Box NearSurface::displacements_within(const Box& range) const { return widened(range, widen_, most_turned_); }

const Box& NearSurface::displacements() const {
  find_moved();
  return displacements_;
}

Box NearSurface::displacements(const Bound& bound) const {
  find_moved();
  const auto moved = [&](Index s) { return moved_[std::size_t(bound_spheres_[std::size_t(s)])]; };
  Box range(moved(bound.first_sphere));
  for (Index s = bound.first_sphere + 1; s < bound.last_sphere; ++s) range.add(moved(s));
  return widened(range, bound.widen, bound.turned);
}

Vec3 NearSurface::carried(Index vertex) {
  const auto v = std::size_t(vertex);
  if (std::exchange(carried_in_[v], round_) == round_) return carried_[v];
  Vec3 sum;
  for (auto e = std::size_t(first_[v]); e < std::size_t(first_[v + 1]); ++e)
    sum += weight_[e] * position_[std::size_t(in_spheres_[e])];
  return carried_[v] = sum;
}

Box NearSurface::around(const Triangle& triangle) {
  const auto around_corner = [&](Index vertex) { return Box(carried(vertex)).grown(offset_size(vertex)); };
  Box box = around_corner(triangle.corner[0]);
  for (const Index corner : {triangle.corner[1], triangle.corner[2]}) {
    const Box other = around_corner(corner);
    box.add(other.low), box.add(other.high);
  }
  return box;
}

Vec3 NearSurface::place(Index vertex) {
  if (offset_size(vertex) == 0) return carried(vertex);
  const auto v = std::size_t(vertex);
  if (std::exchange(placed_in_[v], round_) == round_) return placed_[v];
  return placed_[v] = carried(vertex) + offset(vertex);
}

NearSurface::Turned& NearSurface::turned(Index frame) const {
  Turned& turned = frame_turned_[std::size_t(frame)];
  if (std::exchange(turned.round, round_) == round_) return turned;
  turned.moment = moment_of(frame_[std::size_t(frame)], [&](Index sphere) { return position_[std::size_t(sphere)]; });
  turned.turn = turn_of(turned.moment);
  return turned;
}

Vec3 NearSurface::offset(Index vertex) const {
  Vec3 sum;
  for (const TurnedOffset& offset : turned_of(vertex)) sum += turned(offset.frame).turn(offset.offset);
  return sum;
}

TurnBound NearSurface::offset_bound(Index vertex) const {
  TurnBound all{0, std::numeric_limits<double>::infinity()};
  for (const TurnedOffset& offset : turned_of(vertex)) {
    Turned& frame = turned(offset.frame);
    if (std::exchange(frame.bound_round, round_) != round_)
      frame.bound = bound_turn(frame_[std::size_t(offset.frame)], frame.moment);
    all.rate += frame.bound.rate * norm(offset.offset), all.reach = std::min(all.reach, frame.bound.reach);
  }
  return all;
}

}  // namespace ctpm::surface
