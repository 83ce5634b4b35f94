#include "core/contact/near_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace ctpm::contact {
namespace {

/// Groups are looked at before they must when this part of the margin is used up (our choice).
constexpr double kUsed = 0.5;

/// Of them so many triangles are visited in a round (our choice: some hundredths of a millisecond).
constexpr std::size_t kMostAtOnce = 384;

}  // namespace

Reach Reach::grown(double by) const {
  Reach wider = *this;
  wider.box = box.grown(by), wider.farthest += by;
  return wider;
}

Reach Reach::moved(Vec3 by) const {
  Reach there = *this;
  there.box = box.moved(Box(by)), there.centre += by;
  return there;
}

double Reach::beyond(const Reach& other) const {
  const Vec3 low = other.box.low - box.low, high = box.high - other.box.high;
  const double far = std::isinf(other.farthest) ? 0 : norm(centre - other.centre) + farthest - other.farthest;
  return std::max({0.0, low.x, low.y, low.z, high.x, high.y, high.z, far});
}

double Reach::clearance(const Box& other) const {
  const Vec3 below = other.low - box.high, above = box.low - other.high;
  return std::max({below.x, below.y, below.z, above.x, above.y, above.z, gap(other, Box(centre)) - farthest});
}

NearTriangles::NearTriangles(const std::vector<BallPart>& whole, std::int32_t slots, CutSurfaces& cuts,
                             std::int32_t kind)
    : cuts_(cuts), kind_(kind), whole_(whole.size()), whole_slots_(slots), all_(whole), round_(whole.size(), 0) {
  // As long as nothing is cut, only the first tick takes memory.
  std::size_t triangles = 0;
  for (const BallPart& part : whole) triangles += part.surface->triangles().size();
  found_.reserve(triangles), parts_.reserve(whole_);
  find_groups();
}

/// Begins with the parts that there are.
void NearTriangles::find_groups() {
  all_.resize(whole_), groups_.clear(), version_.reset(), is_listed_ = false;
  stretch_ = 1, all_path_ = std::numeric_limits<double>::infinity();
  cuts_.for_each([&](cutbody::CutPatch& patch) {
    all_.push_back({0, cuts_.first_point(kind_, patch), &patch.body.surface, &patch.gathering, &patch});
  });
  for (std::size_t part = 0; part < all_.size(); ++part) {
    const surface::NearSurface& surface = *all_[part].surface;
    stretch_ = std::max(stretch_, surface.stretch());
    for (std::size_t number = 0; number < surface.groups().size(); ++number) {
      Group& group = groups_.emplace_back(Group{part, number});
      const surface::NearSurface::Bound& bound = surface.groups()[number];
      group.spheres.reserve(std::size_t(bound.last_sphere - bound.first_sphere));
      surface.for_each_sphere(bound, [&](std::int32_t sphere) { group.spheres.add(sphere); });
      if (part >= whole_) continue;  // memory for all of what a cut left would be much at once
      group.found.reserve(std::size_t(surface.patches()[std::size_t(bound.last) - 1].last -
                                      surface.patches()[std::size_t(bound.first)].first));
    }
  }
  version_ = cuts_.version();
}

void NearTriangles::find(const Reach& reach, double margin, const Vec3Array& position) {
  if (version_ != cuts_.version()) find_groups();
  follow(reach, position);
  std::size_t visited = 0;
  for (Group& group : groups_) {
    // How far all have come bounds how far its own spheres have.
    const double most = group.used + (all_path_ - group.all_path),
                 enough = group.found.empty() ? group.allowed : kUsed * group.allowed;
    if (most + kRounding < enough) continue;
    const double used = find_used(group) + kRounding;
    const bool may_wait = used < group.allowed;
    if (may_wait && (used < enough || visited >= kMostAtOnce)) continue;
    is_listed_ = false;
    const std::size_t triangles = look_at(group, reach, margin);
    if (may_wait) visited += triangles;
  }
  if (!is_listed_) list();
  for (const BallPart& part : std::span(parts_).subspan(whole_)) cuts_.begin(*part.patch);
}

/// Adds to the paths how far the reach and the spheres, seen from the ball, have come since the last round.
void NearTriangles::follow(const Reach& reach, const Vec3Array& position) {
  const Vec3 by = reach.centre - reach_.centre;
  const double grown = reach.beyond(reach_.moved(by));
  grown_ += grown, all_path_ += grown + stretch_ * follow_spheres(position, by);
  reach_ = reach;
  if (all_path_ < kLongestPath) return;
  grown_ = all_path_ = 0;
  for (Group& group : groups_) group.allowed = -1, group.used = group.grown = group.all_path = 0;
}

/// How far the farthest sphere has come since the last round, seen from a ball that moved `by` [m].
double NearTriangles::follow_spheres(const Vec3Array& position, Vec3 by) {
  position_.resize(position.size());
  double farthest = 0;
  for (std::size_t part = 0; part < whole_; ++part) {
    const surface::NearSurface& surface = *all_[part].surface;
    const std::span<const std::int32_t> spheres = surface.spheres();
    if (spheres.empty()) continue;
    // Where the surface's round goes on, none of its spheres has moved, and they need not be looked at.
    if (std::exchange(round_[part], surface.round()) == surface.round()) {
      farthest = std::max(farthest, norm(by));
      continue;
    }
    const auto begin = spheres.front(), end = spheres.back() + 1;
    farthest = std::max(farthest, farthest_moved(position_, std::size_t(begin), std::size_t(end), position, 0, by));
    for (const auto axis : {&Vec3Array::x, &Vec3Array::y, &Vec3Array::z})
      std::copy((position.*axis).begin() + begin, (position.*axis).begin() + end, (position_.*axis).begin() + begin);
  }
  return farthest;
}

/// Brings up to date how much of what is allowed a group has used.
double NearTriangles::find_used(Group& group) {
  const Vec3 ball = reach_.centre - std::exchange(group.centre, reach_.centre);
  const double farthest = group.spheres.farthest_moved(position_, [&](Vec3 by) { return norm(by - ball); });
  const double stretch = 1 + 2 * all_[group.part].surface->groups()[group.number].widen;
  group.used += grown_ - std::exchange(group.grown, grown_) + stretch * farthest;
  group.all_path = all_path_;
  return group.used;
}

/// Returns how many triangles were visited.
std::size_t NearTriangles::look_at(Group& group, const Reach& reach, double margin) {
  const BallPart& part = all_[group.part];
  surface::NearSurface& surface = *part.surface;
  if (part.patch != nullptr) cuts_.begin(*part.patch);
  group.used = 0, group.found.clear();
  const surface::NearSurface::Bound& bound = surface.groups()[group.number];
  const double clearance = reach.clearance(bound.rest.moved(surface.displacements(bound)));
  if (clearance > margin) return group.allowed = clearance, 0;
  group.allowed = margin;
  const Reach around = reach.grown(margin + kRounding);
  std::size_t visited = 0;
  surface.near_of_group(around, group.number, [&](const surface::NearSurface::Triangle& triangle) {
    ++visited;
    const Box box = surface.around(triangle);
    if (around.meets(box)) group.found.push_back({&triangle, gap(box, Box(reach.centre))});
  });
  return visited;
}

/// Lists what was found in all groups.
void NearTriangles::list() {
  parts_.assign(all_.begin(), all_.begin() + std::ptrdiff_t(whole_)), found_.clear(), slots_ = whole_slots_;
  std::size_t last = whole_ - 1;  // the part that was listed last
  for (std::size_t number = 0; number < groups_.size(); ++number) {
    const Group& group = groups_[number];
    if (group.found.empty()) continue;
    if (group.part >= whole_ && last != group.part) {
      last = group.part, parts_.push_back(all_[last]);
      parts_.back().first_slot = slots_, slots_ += parts_.back().slots();
    }
    const std::size_t part = group.part < whole_ ? group.part : parts_.size() - 1;
    for (const Candidate& candidate : group.found)
      found_.push_back({std::int32_t(part), candidate.triangle, std::int32_t(number), candidate.apart});
  }
}

}  // namespace ctpm::contact
