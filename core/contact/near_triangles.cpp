#include "core/contact/near_triangles.h"

#include <cmath>

namespace ctpm::contact {

Reach Reach::grown(double by) const {
  Reach wider = *this;
  wider.box = box.grown(by), wider.farthest += by;
  return wider;
}

bool Reach::contains(const Reach& other) const {
  const auto is_in = [](double low, double high, double from, double to) { return low <= from && to <= high; };
  return is_in(box.low.x, box.high.x, other.box.low.x, other.box.high.x) &&
         is_in(box.low.y, box.high.y, other.box.low.y, other.box.high.y) &&
         is_in(box.low.z, box.high.z, other.box.low.z, other.box.high.z) &&
         norm(other.centre - centre) + other.farthest <= farthest;
}

NearTriangles::NearTriangles(const std::vector<BallPart>& whole, std::int32_t slots, CutSurfaces& cuts,
                             std::int32_t kind)
    : cuts_(cuts), kind_(kind), whole_(whole.size()), whole_slots_(slots), parts_(whole), slots_(slots) {
  std::size_t triangles = 0;
  for (const BallPart& part : whole) triangles += part.surface->triangles().size();
  found_.reserve(triangles);
}

/// Whether nothing that `reach` may meet is missing.
bool NearTriangles::holds(const Reach& reach, const Vec3Array& position) const {
  if (!has_looked_ || version_ != cuts_.version() || position_.size() != position.size()) return false;
  double farthest_squared = 0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double x = position.x[i] - position_.x[i], y = position.y[i] - position_.y[i],
                 z = position.z[i] - position_.z[i];
    farthest_squared = std::max(x * x + y * y + z * z, farthest_squared);
  }
  return looked_.grown(margin_).contains(reach.grown(stretch_ * std::sqrt(farthest_squared)));
}

void NearTriangles::find(const Reach& reach, double margin, const Vec3Array& position) {
  if (!holds(reach, position)) {
    margin_ = margin, looked_ = reach, version_ = cuts_.version(), position_ = position, has_looked_ = true;
    return look(reach.grown(margin));
  }
  for (std::size_t part = whole_; part < parts_.size(); ++part) cuts_.begin(*parts_[part].patch);
}

void NearTriangles::look(const Reach& reach) {
  parts_.resize(whole_), found_.clear(), slots_ = whole_slots_;
  stretch_ = cuts_.any() ? cutbody::CutPatches::kStretch : 1;
  for (const BallPart& part : parts_) stretch_ = std::max(stretch_, part.surface->stretch());
  cuts_.near(reach, [&](cutbody::CutPatch& patch) {
    parts_.push_back({slots_, cuts_.first_point(kind_, patch), &patch.body.surface, &patch.gathering, &patch});
    slots_ += parts_.back().slots();
  });
  for (std::size_t part = 0; part < parts_.size(); ++part)
    parts_[part].surface->near(reach, [&](const surface::NearSurface::Triangle& triangle, const Vec3* corners) {
      if (reach.meets(Box(corners[0], corners[1], corners[2]))) found_.push_back({std::int32_t(part), &triangle});
    });
}

}  // namespace ctpm::contact
