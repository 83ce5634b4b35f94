#include "core/contact/point_contact.h"

#include <algorithm>

namespace ctpm::contact {

Vec3 weighted(Carriers at, const Vec3Array& values) {
  Vec3 sum;
  for (std::size_t i = 0; i < at.sphere.size(); ++i) sum += at.weight[i] * values[std::size_t(at.sphere[i])];
  return sum;
}

double share_of_grip(const PointContact& contact, Vec3 elongation, Vec3 slip) {
  const double force = norm(contact.grip_k * elongation + contact.grip_c * slip);
  return force > contact.most_grip ? contact.most_grip / force : 1.0;
}

PointContacts::PointContacts(const Model& model, std::size_t contacts, std::size_t entries) : model_(model) {
  contacts_.reserve(contacts), sphere_.reserve(entries), weight_.reserve(entries);
  if (contacts == 0) return;
  untouched_.reserve(model.sphere_count());
  is_touched_.assign(model.sphere_count(), 0);
}

void PointContacts::add(PointContact contact, Carriers carriers) {
  contact.first = std::int32_t(sphere_.size()), contact.count = std::int32_t(carriers.sphere.size());
  sphere_.insert(sphere_.end(), carriers.sphere.begin(), carriers.sphere.end());
  weight_.insert(weight_.end(), carriers.weight.begin(), carriers.weight.end());
  contacts_.push_back(contact);
}

void PointContacts::add(const PointContact& contact, std::int32_t a, std::int32_t b, double weight_a, double weight_b) {
  const std::int32_t spheres[2] = {a, b};
  const double weights[2] = {weight_a, weight_b};
  add(contact, {spheres, weights});
}

double PointContacts::mobility(Carriers carriers) const {
  double sum = 0;
  for (std::size_t i = 0; i < carriers.sphere.size(); ++i) {
    const auto sphere = std::size_t(carriers.sphere[i]);
    if (model_.held_axes[sphere] != kAnchored) sum += carriers.weight[i] * carriers.weight[i] / model_.mass[sphere];
  }
  return sum;
}

std::int32_t PointContacts::tool_count(std::size_t hand) const {
  return std::int32_t(
      std::count_if(contacts_.begin(), contacts_.end(), [&](const PointContact& c) { return c.is_of_hand(hand); }));
}

void PointContacts::begin_implicit(double h, const Vec3Array* velocity) {
  for (PointContact& c : contacts_) {
    if (c.point >= 0) {
      const Vec3 slip = c.start - dot(c.axis, c.start) * c.axis;
      const double share = share_of_grip(c, c.gripped + h * c.slip_guess, slip + c.slip_guess);
      c.force -= c.damping * dot(c.axis, c.start) * c.axis + share * (c.grip_k * c.gripped + c.grip_c * slip);
      c.drag = share * (h * c.grip_k + c.grip_c);
    } else if (velocity != nullptr && c.drag > 0) {
      const Vec3 u = weighted(carriers(c), *velocity);
      c.force -= c.drag * (u - dot(c.axis, u) * c.axis);
    }
  }
}

void PointContacts::linearise(double h, elements::Coordinates& force, elements::DiagonalBlocks& blocks) {
  const std::size_t n = model_.sphere_count();
  untouched_.clear();
  for (const PointContact& c : contacts_) {
    const double across = h * c.drag, along = h * (h * c.k + c.damping) - across;
    const Vec3 m = c.axis;
    const double matrix[6] = {along * m.x * m.x + across, along * m.x * m.y, along * m.x * m.z,
                              along * m.y * m.y + across, along * m.y * m.z, along * m.z * m.z + across};
    const Carriers at = carriers(c);
    for (std::size_t e = 0; e < at.sphere.size(); ++e) {
      const auto i = std::size_t(at.sphere[e]);
      if (!is_touched_[i]) {
        is_touched_[i] = 1;
        Untouched& before = untouched_.emplace_back();
        before.sphere = std::int32_t(i);
        for (std::size_t k = 0; k < 3; ++k) before.force[k] = force[k * n + i];
        for (std::size_t k = 0; k < 6; ++k) before.block[k] = blocks[k * n + i];
      }
      const double weight = at.weight[e];
      force[i] += weight * c.force.x, force[n + i] += weight * c.force.y, force[2 * n + i] += weight * c.force.z;
      for (std::size_t k = 0; k < 6; ++k) blocks[k * n + i] += weight * weight * matrix[k];
    }
  }
}

void PointContacts::undo_linearise(elements::Coordinates& force, elements::DiagonalBlocks& blocks) {
  const std::size_t n = model_.sphere_count();
  for (const Untouched& before : untouched_) {
    const auto i = std::size_t(before.sphere);
    for (std::size_t k = 0; k < 3; ++k) force[k * n + i] = before.force[k];
    for (std::size_t k = 0; k < 6; ++k) blocks[k * n + i] = before.block[k];
    is_touched_[i] = 0;
  }
  untouched_.clear();
}

/// Velocity of a contact's point [m/s].
template <class Real>
Vec3 PointContacts::velocity_of(const PointContact& c, const Real* v) const {
  const std::size_t n = model_.sphere_count(), end = std::size_t(c.first + c.count);
  Vec3 u;
  for (auto e = std::size_t(c.first); e < end; ++e) {
    const auto i = std::size_t(sphere_[e]);
    u.x += weight_[e] * double(v[i]), u.y += weight_[e] * double(v[n + i]), u.z += weight_[e] * double(v[2 * n + i]);
  }
  return u;
}

/// The matrix of one contact times its point's velocity `u` [kg m/s].
Vec3 PointContacts::coupling(const PointContact& c, double h, Vec3 u) const {
  const double across = h * c.drag, along = h * (h * c.k + c.damping) - across;
  return along * dot(c.axis, u) * c.axis + across * u;
}

template <bool kLagged, class Real>
void PointContacts::apply_of(double h, const Real* v, Real* result) const {
  const std::size_t n = model_.sphere_count();
  for (const PointContact& c : contacts_) {
    const Vec3 all = coupling(c, h, velocity_of(c, v));
    for (auto e = std::size_t(c.first); e < std::size_t(c.first + c.count); ++e) {
      const auto i = std::size_t(sphere_[e]);
      Vec3 q = all;
      if (kLagged) q -= coupling(c, h, weight_[e] * Vec3{v[i], v[n + i], v[2 * n + i]});
      result[i] += Real(weight_[e] * q.x), result[n + i] += Real(weight_[e] * q.y);
      result[2 * n + i] += Real(weight_[e] * q.z);
    }
  }
}
template void PointContacts::apply_of<false>(double h, const double* v, double* result) const;
template void PointContacts::apply_of<true>(double h, const float* v, float* result) const;
template void PointContacts::apply_of<true>(double h, const double* v, double* result) const;

bool PointContacts::pulls(const PointContact& c, double h, const elements::Coordinates& v) const {
  return c.only_pushes && dot(c.axis, c.force - coupling(c, h, velocity_of(c, v.data())) / h) < 0;
}

bool PointContacts::overtakes(const PointContact& c, double h, const elements::Coordinates& v) const {
  return c.near_k > 0 && c.overtakes(h, velocity_of(c, v.data()));
}

bool PointContacts::has_wrong(double h, const elements::Coordinates& v) const {
  return std::any_of(contacts_.begin(), contacts_.end(),
                     [&](const PointContact& c) { return pulls(c, h, v) || overtakes(c, h, v); });
}

void PointContacts::mend_wrong(double h, const elements::Coordinates& v) {
  std::erase_if(contacts_, [&](const PointContact& c) { return pulls(c, h, v); });
  for (PointContact& c : contacts_)
    if (overtakes(c, h, v)) c.hold_near(h);
}

Vec3 PointContacts::force_on_tool(std::size_t hand, double h, const elements::Coordinates& v) const {
  Vec3 force;
  for (const PointContact& c : contacts_)
    if (c.is_of_hand(hand)) force += coupling(c, h, velocity_of(c, v.data())) / h - c.force;
  return force;
}

}  // namespace ctpm::contact
