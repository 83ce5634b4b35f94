#include "core/contact/pressed_point.h"

#include <algorithm>
#include <cmath>

namespace ctpm::contact {

void press(const StateView& state, double friction, double mobility, const Approach& approach, const PressStep& step,
           PointContact& contact) {
  const Vec3 normal = contact.axis;
  const auto across = [&](Vec3 v) { return v - dot(v, normal) * normal; };
  const std::ptrdiff_t before = state.find_touched(contact.point);
  contact.only_pushes = true;
  contact.found = approach.place;
  contact.kelvin_dent = before < 0 ? 0 : state.kelvin_dent[std::size_t(before)];
  contact.k = contact.foundation.k;
  const double pressure = std::max(0.0, contact.foundation.force(contact.dent, contact.kelvin_dent));
  contact.force = pressure * normal;
  const double fastest = approach.farther / step.h;
  const double leaving = std::clamp(dot(approach.start, normal), -approach.nearer / step.h, fastest);
  // A device's jump by 1e300 m must not overflow.
  const auto bounded = [&](double x) { return std::clamp(x, -fastest, fastest); };
  const Vec3 slip = across(approach.start);
  contact.start = Vec3{bounded(slip.x), bounded(slip.y), bounded(slip.z)} + leaving * normal;
  contact.grip_k = friction > 0 ? contact.k : 0.0;
  contact.grip_c = 2 * std::sqrt(contact.grip_k / mobility);  // critical
  contact.most_grip = friction * pressure;
  // On a ball State holds the place. Elsewhere the point is a mean over a facet, whose weights change from step to
  // step, so State holds the stretch, to which the motion since then is added.
  if (before < 0)
    contact.anchor = contact.found;
  else if (contact.hand >= 0)
    contact.anchor = state.grip[std::size_t(before)];
  else
    contact.anchor = contact.found - state.grip[std::size_t(before)] - step.ahead * across(approach.start);
  contact.gripped = across(contact.found - contact.anchor);
  contact.slip_guess = across(approach.slip_guess);
}

void CarrierSum::clear() {
  for (const std::int32_t sphere : sphere_) place_[std::size_t(sphere)] = -1;
  sphere_.clear(), weight_.clear();
}

void CarrierSum::add(Carriers point, double weight) {
  for (std::size_t i = 0; i < point.sphere.size(); ++i) {
    std::int32_t& place = place_[std::size_t(point.sphere[i])];
    if (place < 0) {
      place = std::int32_t(sphere_.size());
      sphere_.push_back(point.sphere[i]), weight_.push_back(0);
    }
    weight_[std::size_t(place)] += weight * point.weight[i];
  }
}

void CarrierSum::move(const Vec3Array& position, Vec3 by) {
  Vec3 mean;
  for (const std::int32_t sphere : sphere_) mean += position[std::size_t(sphere)];
  mean = mean / double(std::max<std::size_t>(sphere_.size(), 1));
  // Second moments of the places, and the gradient of the change, by Cramer's rule.
  Vec3 x, y, z;
  for (const std::int32_t sphere : sphere_) {
    const Vec3 d = position[std::size_t(sphere)] - mean;
    x += d.x * d, y += d.y * d, z += d.z * d;
  }
  constexpr double kFlat = 1e-9;
  const double determinant = dot(x, cross(y, z)), size = x.x + y.y + z.z;
  if (!(determinant > kFlat * size * size * size)) return;
  const Vec3 gradient = Vec3{dot(by, cross(y, z)), dot(by, cross(z, x)), dot(by, cross(x, y))} / determinant;
  for (std::size_t i = 0; i < sphere_.size(); ++i)
    weight_[i] += dot(position[std::size_t(sphere_[i])] - mean, gradient);
}

}  // namespace ctpm::contact
