#include "core/contact/explicit_solve.h"

#include <algorithm>

#include "core/contact/contact_law.h"

namespace ctpm::contact {
namespace {

constexpr int kMostRounds = 5;  ///< of mending contacts that pull or draw too far, and of following the friction cone
constexpr int kFrictionRounds = 3;    ///< at least, where something grips
constexpr int kMostIterations = 200;  ///< of conjugate gradients
constexpr double kSolved = 1e-16;     ///< squared residual relative to the first

Vec3 times(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace

ExplicitSolve::ExplicitSolve(const Model& model, const PointContacts& contacts) : model_(model) {
  if (model.solver.integrator != Integrator::leapfrog || contacts.capacity() == 0) return;
  const std::size_t n = model.sphere_count();
  linear_.reserve(contacts.capacity()), place_.resize(contacts.sphere_.capacity());
  index_.assign(n, -1);
  touched_.reserve(n);
  for (auto* array : {&free_, &diagonal_, &residual_, &change_, &direction_, &product_}) array->resize(n);
}

/// Numbers the spheres that contacts touch.
void ExplicitSolve::gather(const Pins& pins, const PointContacts& contacts) {
  touched_.clear();
  place_.resize(std::max(place_.size(), contacts.sphere_.size()));  // a cut may add to what was reserved
  for (const PointContact& contact : contacts.all())
    for (auto e = std::size_t(contact.first); e < std::size_t(contact.first + contact.count); ++e) {
      const std::int32_t sphere = contacts.sphere_[e];
      const auto i = std::size_t(sphere);
      if (index_[i] >= 0) {
        place_[e] = index_[i];
        continue;
      }
      const std::size_t place = touched_.size();
      place_[e] = index_[i] = std::int32_t(place);
      touched_.push_back(sphere);
      const std::uint8_t held = held_axes(pins, model_, i);
      free_[place] = {held & 1 ? 0.0 : 1.0, held & 2 ? 0.0 : 1.0, held & 4 ? 0.0 : 1.0};
    }
}

/// Sum of weight times value over a contact's spheres; `values`: of the touched spheres.
Vec3 ExplicitSolve::change_at(const PointContact& contact, Carriers at, const std::vector<Vec3>& values) const {
  const std::int32_t* place = &place_[std::size_t(contact.first)];
  Vec3 sum;
  for (std::size_t i = 0; i < at.weight.size(); ++i) sum += at.weight[i] * values[std::size_t(place[i])];
  return sum;
}

/// Adds weight times `value` to those of a contact's spheres.
void ExplicitSolve::spread(const PointContact& contact, Carriers at, Vec3 value, std::vector<Vec3>& values) const {
  const std::int32_t* place = &place_[std::size_t(contact.first)];
  for (std::size_t i = 0; i < at.weight.size(); ++i) values[std::size_t(place[i])] += at.weight[i] * value;
}

/// `change`: of the point's velocity by the contacts, as far as it is known, from which friction follows.
ExplicitSolve::Linear ExplicitSolve::linearise(const PointContact& c, Carriers at, double h, const Vec3Array& before,
                                               const Vec3Array& velocity, Vec3 change, double mobility) const {
  const auto across = [&](Vec3 v) { return v - dot(v, c.axis) * c.axis; };
  const ContactShares share(h * h * c.k * mobility, h * c.damping * mobility);
  const Vec3 old = weighted(at, before), start = c.point >= 0 ? c.start : old;
  const Vec3 relative = start + weighted(at, velocity) - old;
  // The grip acts at its elongation at the end of the step.
  const Vec3 slip = across(relative + change);
  const double reach = 0.5 * h, grip = share_of_grip(c, c.gripped + reach * slip, slip);
  Linear linear;
  linear.along = h * c.k * share.after + c.damping * share.damped_after;
  linear.across = c.drag + grip * (c.grip_k * reach + c.grip_c);
  linear.slip = across(relative);
  linear.force = c.force - grip * c.grip_k * c.gripped - linear.across * linear.slip;
  linear.force += ((h * c.k * share.before - c.damping * share.damped_before) * dot(c.axis, start) -
                   linear.along * dot(c.axis, relative)) *
                  c.axis;
  return linear;
}

/// Right-hand side and diagonal of the system.
void ExplicitSolve::assemble(double h, const PointContacts& contacts) {
  for (std::size_t p = 0; p < touched_.size(); ++p) {
    const double mass = model_.mass[std::size_t(touched_[p])];
    diagonal_[p] = {mass, mass, mass}, residual_[p] = {};
  }
  for (std::size_t i = 0; i < contacts.count(); ++i) {
    const PointContact& c = contacts.all()[i];
    const Linear& linear = linear_[i];
    const Carriers at = contacts.carriers(c);
    const double more = h * (linear.along - linear.across), isotropic = h * linear.across;
    const Vec3 block{more * c.axis.x * c.axis.x + isotropic, more * c.axis.y * c.axis.y + isotropic,
                     more * c.axis.z * c.axis.z + isotropic};
    for (std::size_t e = 0; e < at.sphere.size(); ++e) {
      const auto p = std::size_t(place_[std::size_t(c.first) + e]);
      residual_[p] += h * at.weight[e] * linear.force;
      diagonal_[p] += at.weight[e] * at.weight[e] * block;
    }
  }
  for (std::size_t p = 0; p < touched_.size(); ++p) residual_[p] = times(residual_[p], free_[p]);
}

/// product = matrix times direction.
void ExplicitSolve::multiply(double h, const PointContacts& contacts) {
  for (std::size_t p = 0; p < touched_.size(); ++p) product_[p] = model_.mass[std::size_t(touched_[p])] * direction_[p];
  for (std::size_t i = 0; i < contacts.count(); ++i) {
    const PointContact& c = contacts.all()[i];
    const Linear& linear = linear_[i];
    const Carriers at = contacts.carriers(c);
    const Vec3 u = change_at(c, at, direction_);
    const Vec3 q = h * ((linear.along - linear.across) * dot(c.axis, u) * c.axis + linear.across * u);
    spread(c, at, q, product_);
  }
  for (std::size_t p = 0; p < touched_.size(); ++p) product_[p] = times(product_[p], free_[p]);
}

/// Conjugate gradients with a diagonal preconditioner (Saad, "Iterative methods for sparse linear systems", 2003).
void ExplicitSolve::run_conjugate_gradients(double h, const PointContacts& contacts) {
  const std::size_t n = touched_.size();
  const auto conditioned = [&](std::size_t p) {
    const Vec3 r = residual_[p], d = diagonal_[p];
    return Vec3{r.x / d.x, r.y / d.y, r.z / d.z};
  };
  const auto energy_of_residual = [&] {
    double sum = 0;
    for (std::size_t p = 0; p < n; ++p) sum += dot(residual_[p], conditioned(p));
    return sum;
  };
  const double enough = energy_of_residual() * kSolved;
  // Starts from the change of the round before.
  for (std::size_t p = 0; p < n; ++p) direction_[p] = change_[p];
  multiply(h, contacts);
  for (std::size_t p = 0; p < n; ++p) residual_[p] -= product_[p];
  double energy = energy_of_residual();
  for (std::size_t p = 0; p < n; ++p) direction_[p] = conditioned(p);
  for (int i = 0; i < kMostIterations && energy > enough; ++i) {
    multiply(h, contacts);
    double curvature = 0;
    for (std::size_t p = 0; p < n; ++p) curvature += dot(direction_[p], product_[p]);
    if (!(curvature > 0)) break;
    const double step = energy / curvature;
    for (std::size_t p = 0; p < n; ++p) change_[p] += step * direction_[p], residual_[p] -= step * product_[p];
    const double next = energy_of_residual(), turn = next / energy;
    for (std::size_t p = 0; p < n; ++p) direction_[p] = conditioned(p) + turn * direction_[p];
    energy = next;
  }
}

std::array<Vec3, kMostHands> ExplicitSolve::solve(double h, const Pins& pins, const Vec3Array& before,
                                                  Vec3Array& velocity, PointContacts& contacts) {
  if (contacts.count() == 0) return {};
  gather(pins, contacts);
  for (std::size_t p = 0; p < touched_.size(); ++p) change_[p] = {};
  std::array<Vec3, kMostHands> on_tool;
  for (int round = 1; round <= kMostRounds; ++round) {
    linear_.clear();
    for (const PointContact& c : contacts.all()) {
      const Carriers at = contacts.carriers(c);
      linear_.push_back(linearise(c, at, h, before, velocity, change_at(c, at, change_), contacts.mobility(at)));
    }
    assemble(h, contacts);
    run_conjugate_gradients(h, contacts);
    on_tool = {};
    std::fill(product_.begin(), product_.begin() + std::ptrdiff_t(touched_.size()), Vec3{});
    std::size_t next = 0;
    bool grips = false, changed = false;
    for (std::size_t i = 0; i < contacts.count(); ++i) {
      PointContact& c = contacts.contacts_[i];
      const Vec3 u = change_at(c, contacts.carriers(c), change_);
      const Vec3 acting =
          linear_[i].force - (linear_[i].along - linear_[i].across) * dot(c.axis, u) * c.axis - linear_[i].across * u;
      if (c.only_pushes && dot(c.axis, acting) < 0 && round < kMostRounds) continue;
      if (c.near_k > 0 && round < kMostRounds && c.overtakes(h, weighted(contacts.carriers(c), velocity) + u))
        c.hold_near(h), changed = true;
      if (c.hand >= 0) on_tool[std::size_t(c.hand)] -= acting;
      const Carriers at = contacts.carriers(c);
      spread(c, at, acting, product_);
      grips = grips || c.grip_k > 0;
      contacts.contacts_[next++] = c;
    }
    changed = changed || next < contacts.count();
    contacts.contacts_.resize(next);
    if (!changed && (!grips || round >= kFrictionRounds)) break;
  }
  for (std::size_t p = 0; p < touched_.size(); ++p) {
    const auto i = std::size_t(touched_[p]);
    index_[i] = -1;
    // From the forces themselves, so that momentum is kept whatever the solve left unsolved.
    velocity.add(i, h / model_.mass[i] * times(free_[p], product_[p]));
  }
  return on_tool;
}

}  // namespace ctpm::contact
