#include "core/contact/pair_contact.h"

#include <algorithm>

#include "core/contact/contact_law.h"

namespace ctpm::contact {

void PairContacts::start_from(const Vec3Array& velocity) {
  for (PairContact& c : contacts_) {
    const Vec3 u = c.weight_a * velocity[std::size_t(c.a)] + c.weight_b * velocity[std::size_t(c.b)];
    c.force -= c.drag * (u - dot(c.axis, u) * c.axis);
  }
}

void PairContacts::linearise(double h, elements::Coordinates& force, elements::DiagonalBlocks& blocks) {
  const std::size_t n = model_.sphere_count();
  for (PairContact& c : contacts_) {
    const double across = h * c.drag, along = h * h * c.k - across;
    const auto load = [&](std::int32_t sphere, double weight, double* without) {
      const auto i = std::size_t(sphere);
      for (std::size_t k = 0; k < 3; ++k) without[k] = force[k * n + i];
      for (std::size_t k = 0; k < 6; ++k) without[3 + k] = blocks[k * n + i];
      const Vec3 share = weight * c.force, m = c.axis;
      force[i] += share.x, force[n + i] += share.y, force[2 * n + i] += share.z;
      double* block = &blocks[i];
      const double w = weight * weight;
      block[0] += w * (along * m.x * m.x + across), block[n] += w * along * m.x * m.y;
      block[2 * n] += w * along * m.x * m.z, block[3 * n] += w * (along * m.y * m.y + across);
      block[4 * n] += w * along * m.y * m.z, block[5 * n] += w * (along * m.z * m.z + across);
    };
    load(c.a, c.weight_a, &c.without[0]), load(c.b, c.weight_b, &c.without[9]);
  }
}

void PairContacts::undo_linearise(elements::Coordinates& force, elements::DiagonalBlocks& blocks) const {
  const std::size_t n = model_.sphere_count();
  const auto restore = [&](std::int32_t sphere, const double* without) {
    const auto i = std::size_t(sphere);
    for (std::size_t k = 0; k < 3; ++k) force[k * n + i] = without[k];
    for (std::size_t k = 0; k < 6; ++k) blocks[k * n + i] = without[3 + k];
  };
  // In reverse order, since a sphere may have several contacts.
  for (auto c = contacts_.rbegin(); c != contacts_.rend(); ++c)
    restore(c->b, &c->without[9]), restore(c->a, &c->without[0]);
}

Vec3 PairContacts::push_apart(double h, const Pin& pin, const Vec3Array& before, Vec3Array& velocity) {
  std::vector<double>* const axes[3] = {&velocity.x, &velocity.y, &velocity.z};
  const auto inverse_mass = [&](std::int32_t sphere) {
    const auto i = std::size_t(sphere);
    return pin.held_axes(model_, i) == kAnchored ? 0.0 : 1 / model_.mass[i];
  };
  const auto kick = [&](std::int32_t sphere, Vec3 change) {
    const auto i = std::size_t(sphere);
    const double parts[3] = {change.x, change.y, change.z};
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((pin.held_axes(model_, i) >> axis & 1) == 0) (*axes[axis])[i] += parts[axis];
  };
  Vec3 on_tool;
  for (const PairContact& c : contacts_) {
    const double per_a = inverse_mass(c.a), per_b = inverse_mass(c.b);
    const double ease = c.weight_a * c.weight_a * per_a + c.weight_b * c.weight_b * per_b;
    const double across = h * c.drag, k = h * h * c.k;
    const ContactShares share(ease * k, 0);
    const Vec3 u = c.weight_a * velocity[std::size_t(c.a)] + c.weight_b * velocity[std::size_t(c.b)],
               old = c.weight_a * before[std::size_t(c.a)] + c.weight_b * before[std::size_t(c.b)];
    const double moved = share.after * dot(c.axis, u) - share.before * dot(c.axis, old);
    const Vec3 wanted = h * c.force - across * (u - dot(c.axis, u) * c.axis) - k * moved * c.axis;
    const double wanted_along = dot(wanted, c.axis), given_along = wanted_along / (1 + ease * k * share.after);
    if (c.only_pushes && given_along < 0) continue;
    const Vec3 impulse = (wanted - wanted_along * c.axis) / (1 + ease * across) + given_along * c.axis;
    kick(c.a, c.weight_a * per_a * impulse), kick(c.b, c.weight_b * per_b * impulse);
    if (c.is_tool) on_tool -= impulse / h;
  }
  return on_tool;
}

/// Velocity of a contact's point [m/s].
template <class Real>
Vec3 PairContacts::velocity_of(const PairContact& c, const Real* v) const {
  const std::size_t n = model_.sphere_count(), a = std::size_t(c.a), b = std::size_t(c.b);
  return c.weight_a * Vec3{v[a], v[n + a], v[2 * n + a]} + c.weight_b * Vec3{v[b], v[n + b], v[2 * n + b]};
}

/// The matrix of one contact times its point's velocity `u` [kg m/s].
Vec3 PairContacts::coupling(const PairContact& c, double h, Vec3 u) const {
  const double across = h * c.drag, along = h * h * c.k - across;
  return along * dot(c.axis, u) * c.axis + across * u;
}

template <class Real>
double PairContacts::apply(double h, const Real* v, Real* result) const {
  const std::size_t n = model_.sphere_count();
  double energy = 0;
  for (const PairContact& c : contacts_) {
    const Vec3 u = velocity_of(c, v), q = coupling(c, h, u);
    const auto a = std::size_t(c.a), b = std::size_t(c.b);
    const Vec3 qa = c.weight_a * q, qb = c.weight_b * q;
    result[a] += Real(qa.x), result[n + a] += Real(qa.y), result[2 * n + a] += Real(qa.z);
    result[b] += Real(qb.x), result[n + b] += Real(qb.y), result[2 * n + b] += Real(qb.z);
    energy += dot(u, q);
  }
  return energy;
}
template double PairContacts::apply(double h, const float* v, float* result) const;
template double PairContacts::apply(double h, const double* v, double* result) const;

bool PairContacts::pulls(const PairContact& c, double h, const elements::Coordinates& v) const {
  return c.only_pushes && dot(c.axis, c.force - coupling(c, h, velocity_of(c, v.data())) / h) < 0;
}

bool PairContacts::has_pulling(double h, const elements::Coordinates& v) const {
  return std::any_of(contacts_.begin(), contacts_.end(), [&](const PairContact& c) { return pulls(c, h, v); });
}

void PairContacts::drop_pulling(double h, const elements::Coordinates& v) {
  std::erase_if(contacts_, [&](const PairContact& c) { return pulls(c, h, v); });
}

Vec3 PairContacts::force_on_tool(double h, const elements::Coordinates& v) const {
  Vec3 force;
  for (const PairContact& c : contacts_)
    if (c.is_tool) force += coupling(c, h, velocity_of(c, v.data())) / h - c.force;
  return force;
}

std::int32_t PairContacts::tool_count() const {
  return std::int32_t(
      std::count_if(contacts_.begin(), contacts_.end(), [](const PairContact& c) { return c.is_tool; }));
}

}  // namespace ctpm::contact
