#include "core/contact/near_obstacle.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ctpm::contact {
namespace {

/// What will be due after fewer rounds like the last one is looked at in each: to wait would cost more, and most where
/// tissue turns (our choices).
constexpr double kWorthWaiting = 3, kWorthTurning = 30;

}  // namespace

NearObstacle::NearObstacle(const Model& model, surface::Body& body, const surface::ObstacleShape& shape,
                           CutSurfaces& cuts)
    : organ_(model.organs[std::size_t(body.organ)]), body_(body), shape_(shape), cuts_(cuts) {
  // As long as nothing is cut, ticks take no memory.
  const surface::NearSurface& surface = body.surface;
  const std::size_t most = surface.vertex_count() + surface.groups().size() + surface.patches().size();
  for (std::vector<Item>* items : {&always_, &due_}) items->reserve(most);
  found_.reserve(surface.vertex_count()), position_.resize(std::size_t(organ_.count));
  find_parts();
}

const std::vector<NearObstacle::Found>& NearObstacle::find(const Vec3Array& position) {
  step_ = farthest_moved(position_, 0, position_.size(), position, std::size_t(organ_.first), {});
  path_ += step_, ++round_;
  if (version_ != cuts_.version()) find_parts();
  if (!(path_ < kLongestPath)) look_at_all();
  for (std::size_t s = 0; s < position_.size(); ++s) position_.set(s, position[std::size_t(organ_.first) + s]);
  found_.clear();
  due_.insert(due_.end(), always_.begin(), always_.end()), always_.clear();
  for (std::size_t region = 0; region < regions_.size(); ++region)
    if (due_at_[region] <= path_) take_due(region);
  for (; !turning_.empty() && turning_.front().due <= path_; turning_.pop_back())
    due_.push_back(turning_.front()), std::pop_heap(turning_.begin(), turning_.end());
  while (!due_.empty()) {
    const Item item = due_.back();
    due_.pop_back();
    look_at(item);
  }
  const auto key = [](const Found& f) { return std::pair(f.part, f.order); };
  std::sort(found_.begin(), found_.end(), [&](const Found& a, const Found& b) { return key(a) < key(b); });
  return found_;
}

/// Begins with the parts that there are.
void NearObstacle::find_parts() {
  parts_.clear(), regions_.clear(), version_.reset();
  add_part(body_, nullptr);
  if (cutbody::CutPatches* const patches = cuts_.patches(std::size_t(body_.organ)))
    patches->for_each([&](cutbody::CutPatch& patch) { add_part(patch.body, &patch); });
  due_at_.resize(regions_.size());
  version_ = cuts_.version();
  look_at_all();
}

/// All is to be looked at.
void NearObstacle::look_at_all() {
  path_ = 0, turning_.clear(), always_.clear(), due_.clear();
  for (std::size_t number = 0; number < regions_.size(); ++number) {
    Region& region = regions_[number];
    region.path = 0, region.round = 0, region.waiting.clear(), due_at_[number] = INFINITY;
    due_.push_back({0, Kind::group, std::int32_t(number), region.group});
  }
}

void NearObstacle::add_part(surface::Body& body, cutbody::CutPatch* patch) {
  const auto part = std::int32_t(parts_.size());
  const surface::NearSurface& surface = body.surface;
  parts_.push_back({&body, patch, std::vector<std::int32_t>(surface.vertex_count(), -1)});
  std::vector<std::int32_t>& first_corner = parts_.back().first_corner;
  std::int32_t corner = 0;
  for (const surface::NearSurface::Triangle& triangle : surface.triangles())
    for (const std::int32_t vertex : triangle.corner) {
      if (first_corner[std::size_t(vertex)] < 0) first_corner[std::size_t(vertex)] = corner;
      ++corner;
    }
  for (std::size_t group = 0; group < surface.groups().size(); ++group) {
    const surface::NearSurface::Bound& bound = surface.groups()[group];
    Region& region = regions_.emplace_back(Region{part, std::int32_t(group)});
    region.spheres.reserve(std::size_t(bound.last_sphere - bound.first_sphere));
    surface.for_each_sphere(bound, [&](std::int32_t sphere) { region.spheres.add(sphere - organ_.first); });
    // Of its patches and their vertices no more wait than it has corners. Memory for all of what a cut left would be
    // much at once.
    if (patch != nullptr) continue;
    const auto triangles =
        surface.patches()[std::size_t(bound.last) - 1].last - surface.patches()[std::size_t(bound.first)].first;
    region.waiting.reserve(std::size_t(3 * triangles));
  }
}

/// Adds to its path how far its spheres have moved. Before a plane only the way along its normal counts.
void NearObstacle::bring_up_to_date(Region& region) {
  if (region.round == round_) return;
  const Vec3* way = shape_.only_way();
  const double farthest = region.spheres.farthest_moved(
      position_, [&](Vec3 by) { return way != nullptr ? std::abs(dot(by, *way)) : norm(by); });
  region.step = region.round != 0 ? farthest : 0;
  region.path += region.step;
  region.round = round_;
}

/// Has what is due of a region be looked at.
void NearObstacle::take_due(std::size_t number) {
  Region& region = regions_[number];
  bring_up_to_date(region);
  std::vector<Item>& waiting = region.waiting;
  for (; !waiting.empty() && waiting.front().due <= region.path; waiting.pop_back())
    due_.push_back(waiting.front()), std::pop_heap(waiting.begin(), waiting.end());
  due_at_[number] = INFINITY;
  if (!waiting.empty()) schedule(number);
}

/// Its spheres move no farther than the farthest of all.
void NearObstacle::schedule(std::size_t number) {
  const Region& region = regions_[number];
  const double due = region.waiting.front().due;
  due_at_[number] = std::min(due_at_[number], path_ + (due - region.path));
}

void NearObstacle::look_at(Item item) {
  const std::int32_t part = regions_[std::size_t(item.region)].part;
  if (parts_[std::size_t(part)].patch != nullptr) cuts_.begin(*parts_[std::size_t(part)].patch);
  switch (item.kind) {
    case Kind::group:
    case Kind::patch:
      return look_at_bound(item);
    case Kind::vertex:
      return look_at_vertex(item);
  }
}

void NearObstacle::wait(Item item, double clearance, double stretch) {
  const double path = (clearance - kRounding) / stretch;
  if (!(path > 0)) return always_.push_back(item);
  Region& region = regions_[std::size_t(item.region)];
  bring_up_to_date(region);
  if (!(path > kWorthWaiting * region.step)) return always_.push_back(item);
  item.due = region.path + path;
  region.waiting.push_back(item), std::push_heap(region.waiting.begin(), region.waiting.end());
  schedule(std::size_t(item.region));
}

/// The spheres by which its tissue turns may be of other regions, and turn it wherever they move.
void NearObstacle::wait_turning(Item item, double clearance, const surface::NearSurface& surface) {
  const double least = kWorthTurning * step_;
  if (!(clearance - kRounding > least)) return always_.push_back(item);
  const surface::TurnBound turn = surface.offset_bound(item.number);
  const double path = std::min(turn.reach, (clearance - kRounding) / (surface.stretch(item.number) + turn.rate));
  if (!(path > least)) return always_.push_back(item);
  item.due = path_ + path;
  turning_.push_back(item), std::push_heap(turning_.begin(), turning_.end());
}

/// Looks at a run of triangles or of patches by its box.
void NearObstacle::look_at_bound(Item item) {
  const std::int32_t part_number = regions_[std::size_t(item.region)].part;
  const Part& part = parts_[std::size_t(part_number)];
  const surface::NearSurface& surface = part.body->surface;
  const bool is_group = item.kind == Kind::group;
  const surface::NearSurface::Bound& bound =
      (is_group ? surface.groups() : surface.patches())[std::size_t(item.number)];
  const double clearance = shape_.clearance(bound.rest.moved(surface.displacements(bound)));
  if (clearance > 0) return wait(item, clearance, surface.stretch());
  if (is_group) {
    for (std::int32_t patch = bound.first; patch < bound.last; ++patch)
      due_.push_back({0, Kind::patch, item.region, patch});
    return;
  }
  for (std::int32_t corner = 3 * bound.first; corner < 3 * bound.last; ++corner) {
    const std::int32_t vertex = surface.triangles()[std::size_t(corner / 3)].corner[corner % 3];
    if (part.first_corner[std::size_t(vertex)] != corner) continue;
    if (part.patch != nullptr || !cuts_.hides(part.body->first_vertex + vertex))
      due_.push_back({0, Kind::vertex, item.region, vertex});
  }
}

void NearObstacle::look_at_vertex(Item item) {
  const std::int32_t part_number = regions_[std::size_t(item.region)].part;
  const Part& part = parts_[std::size_t(part_number)];
  surface::NearSurface& surface = part.body->surface;
  const double turns = surface.offset_size(item.number);
  double depth;
  if (turns > 0 && (depth = shape_.inside(surface.carried(item.number)).depth) + turns < 0)
    return wait(item, -depth - turns, surface.stretch(item.number));
  const surface::Inside inside = shape_.inside(surface.place(item.number));
  if (inside.depth > 0)
    found_.push_back({part_number, item.number, part.first_corner[std::size_t(item.number)], inside});
  if (turns > 0) return wait_turning(item, -inside.depth, surface);
  wait(item, -inside.depth, surface.stretch(item.number));
}

}  // namespace ctpm::contact
