#include "core/contact/near_obstacle.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/contact/moved.h"

namespace ctpm::contact {

NearObstacle::NearObstacle(const Model& model, surface::Body& body, const surface::ObstacleShape& shape,
                           CutSurfaces& cuts)
    : organ_(model.organs[std::size_t(body.organ)]), body_(body), shape_(shape), cuts_(cuts) {
  // As long as nothing is cut, ticks take no memory.
  const surface::NearSurface& surface = body.surface;
  const std::size_t most = surface.vertex_count() + surface.groups().size() + surface.patches().size();
  for (std::vector<Item>* items : {&waiting_, &always_, &due_}) items->reserve(most);
  found_.reserve(surface.vertex_count()), position_.resize(std::size_t(organ_.count));
  begin_anew();
}

const std::vector<NearObstacle::Found>& NearObstacle::find(const Vec3Array& position) {
  const double moved = has_begun_ ? farthest_moved(position_, position, std::size_t(organ_.first)) : 0;
  path_ += moved;
  if (version_ != cuts_.version() || !std::isfinite(moved)) begin_anew();
  has_begun_ = true;
  for (std::size_t s = 0; s < position_.size(); ++s) position_.set(s, position[std::size_t(organ_.first) + s]);
  found_.clear();
  due_.insert(due_.end(), always_.begin(), always_.end()), always_.clear();
  while (!waiting_.empty() && waiting_.front().due <= path_) {
    due_.push_back(waiting_.front());
    std::pop_heap(waiting_.begin(), waiting_.end()), waiting_.pop_back();
  }
  while (!due_.empty()) {
    const Item item = due_.back();
    due_.pop_back();
    look_at(item);
  }
  const auto key = [&](const Found& f) { return std::tuple(parts_[std::size_t(f.part)].order, f.order); };
  std::sort(found_.begin(), found_.end(), [&](const Found& a, const Found& b) { return key(a) < key(b); });
  return found_;
}

/// All is to be looked at.
void NearObstacle::begin_anew() {
  version_ = cuts_.version(), path_ = 0;
  parts_.clear(), waiting_.clear(), always_.clear(), due_.clear();
  add_part(body_, nullptr, {-1, 0});
  if (cutbody::CutPatches* const patches = cuts_.patches(std::size_t(body_.organ)))
    for (std::size_t block = 0; block < patches->covered_count(); ++block)
      due_.push_back({0, Kind::block, -1, std::int32_t(block)});
}

void NearObstacle::add_part(surface::Body& body, cutbody::CutPatch* patch, std::array<std::int32_t, 2> order) {
  const auto part = std::int32_t(parts_.size());
  parts_.push_back({&body, patch, order, std::vector<std::int32_t>(body.surface.vertex_count(), -1)});
  std::vector<std::int32_t>& first_corner = parts_.back().first_corner;
  std::int32_t corner = 0;
  for (const surface::NearSurface::Triangle& triangle : body.surface.triangles())
    for (const std::int32_t vertex : triangle.corner) {
      if (first_corner[std::size_t(vertex)] < 0) first_corner[std::size_t(vertex)] = corner;
      ++corner;
    }
  for (std::size_t group = 0; group < body.surface.groups().size(); ++group)
    due_.push_back({0, Kind::group, part, std::int32_t(group)});
}

void NearObstacle::look_at(Item item) {
  if (item.part >= 0 && parts_[std::size_t(item.part)].patch != nullptr)
    cuts_.begin(*parts_[std::size_t(item.part)].patch);
  switch (item.kind) {
    case Kind::block:
      return look_at_block(item);
    case Kind::group:
    case Kind::patch:
      return look_at_bound(item);
    case Kind::vertex:
      return look_at_vertex(item);
  }
}

void NearObstacle::wait(Item item, double clearance, double stretch) {
  if (!(clearance > kRounding)) return always_.push_back(item);
  item.due = path_ + (clearance - kRounding) / stretch;
  waiting_.push_back(item), std::push_heap(waiting_.begin(), waiting_.end());
}

void NearObstacle::look_at_block(Item item) {
  cutbody::CutPatches& patches = *cuts_.patches(std::size_t(body_.organ));
  const double clearance = shape_.clearance(patches.box_of(std::size_t(item.number)));
  if (clearance > 0) return wait(item, clearance, cutbody::CutPatches::kStretch);
  std::int32_t number = 0;
  for (const auto& patch : patches.patches(std::size_t(item.number)))
    add_part(patch->body, patch.get(), {item.number, number++});
}

/// Looks at a run of triangles or of patches by its box.
void NearObstacle::look_at_bound(Item item) {
  const Part& part = parts_[std::size_t(item.part)];
  const surface::NearSurface& surface = part.body->surface;
  const bool is_group = item.kind == Kind::group;
  const surface::NearSurface::Bound& bound =
      (is_group ? surface.groups() : surface.patches())[std::size_t(item.number)];
  const double clearance = shape_.clearance(bound.rest.moved(surface.displacements(bound)));
  if (clearance > 0) return wait(item, clearance, surface.stretch());
  if (is_group) {
    for (std::int32_t patch = bound.first; patch < bound.last; ++patch)
      due_.push_back({0, Kind::patch, item.part, patch});
    return;
  }
  for (std::int32_t corner = 3 * bound.first; corner < 3 * bound.last; ++corner) {
    const std::int32_t vertex = surface.triangles()[std::size_t(corner / 3)].corner[corner % 3];
    if (part.first_corner[std::size_t(vertex)] != corner) continue;
    if (part.patch != nullptr || !cuts_.hides(part.body->first_vertex + vertex))
      due_.push_back({0, Kind::vertex, item.part, vertex});
  }
}

void NearObstacle::look_at_vertex(Item item) {
  const Part& part = parts_[std::size_t(item.part)];
  surface::NearSurface& surface = part.body->surface;
  const double turns = surface.offset_size(item.number);
  double depth;
  if (turns > 0 && (depth = shape_.inside(surface.carried(item.number)).depth) + turns < 0)
    return wait(item, -depth - turns, surface.stretch());
  const surface::Inside inside = shape_.inside(surface.place(item.number));
  if (inside.depth > 0) found_.push_back({item.part, item.number, part.first_corner[std::size_t(item.number)], inside});
  wait(item, turns > 0 ? 0 : -inside.depth, surface.stretch());
}

}  // namespace ctpm::contact
