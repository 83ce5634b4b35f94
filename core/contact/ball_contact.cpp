#include "core/contact/ball_contact.h"

#include <algorithm>
#include <cmath>

#include "core/contact/contact_law.h"

namespace ctpm::contact {
namespace {

/// Spheres per block. A block is checked as a whole before its spheres are checked one by one.
constexpr std::size_t kLookedAtOnce = 128;

}  // namespace

BallContact::BallContact(const Model& model, const elements::Kernels& kernels) : model_(model), kernels_(kernels) {
  if (model.has_tool(ToolKind::ball)) contacts_.reserve(model.sphere_count());
  for (const double radius : model.contact_radius) largest_radius_ = std::max(largest_radius_, radius);
}

void BallContact::find(const StateView& state, Vec3 centre, double radius, Vec3 velocity, double h,
                       bool from_velocity) {
  clear();
  velocity_ = velocity;
  const double farthest = (radius + largest_radius_) * (radius + largest_radius_),
               at[3] = {centre.x, centre.y, centre.z};
  for (std::size_t begin = 0; begin < state.position.size(); begin += kLookedAtOnce) {
    const std::size_t end = std::min(begin + kLookedAtOnce, state.position.size());
    const double nearest = kernels_.nearest_squared(state.position.x.data(), state.position.y.data(),
                                                    state.position.z.data(), at, begin, end);
    if (nearest < farthest) find_among(state, centre, radius, h, from_velocity, begin, end);
  }
}

void BallContact::find_among(const StateView& state, Vec3 centre, double radius, double h, bool from_velocity,
                             std::size_t begin, std::size_t end) {
  const Vec3 velocity = velocity_;
  for (std::size_t i = begin; i < end; ++i) {
    if (model_.held_axes[i] == kAnchored) continue;
    const Vec3 apart = state.position[i] - centre;
    const double reach = radius + model_.contact_radius[i];
    const double distance_squared = dot(apart, apart);
    if (distance_squared >= reach * reach) continue;
    const double distance = std::sqrt(distance_squared);
    // A sphere whose centre coincides with that of the ball is pushed in the direction of the ball's motion.
    const Vec3 fallback = norm(velocity) > 0 ? velocity / norm(velocity) : Vec3{0, 0, -1};
    const Vec3 normal = distance > 1e-9 * reach ? apart / distance : fallback;
    const double penetration = reach - distance;
    const Vec3 slip = state.velocity[i] - velocity;
    const double speed = norm(slip - dot(slip, normal) * normal);
    const double drag = contact_drag(model_, penetration, speed);
    const Vec3 from = from_velocity ? slip : -velocity;
    const double towards = dot(from, normal),
                 damping = contact_damping(model_.contact_damping, model_.contact_k, model_.mass[i], penetration);
    contacts_.push_back({std::int32_t(i), normal, penetration, damping, drag,
                         std::clamp(-towards, -reach / h, penetration / h), from - towards * normal});
  }
}

void BallContact::linearise(double h, elements::Coordinates& force, elements::DiagonalBlocks& blocks) {
  const std::size_t spheres = model_.sphere_count();
  for (SphereContact& contact : contacts_) {
    const auto i = std::size_t(contact.sphere);
    for (std::size_t k = 0; k < 3; ++k) contact.without[k] = force[k * spheres + i];
    for (std::size_t k = 0; k < 6; ++k) contact.without[3 + k] = blocks[k * spheres + i];
    const Vec3 n = contact.normal;
    const Vec3 push =
        (model_.contact_k * contact.penetration + contact.damping * contact.approach) * n - contact.drag * contact.slip;
    force[i] += push.x, force[spheres + i] += push.y, force[2 * spheres + i] += push.z;
    const double across = h * contact.drag, along = coupling_along(contact, h) - across;
    double* block = &blocks[i];
    block[0] += along * n.x * n.x + across, block[spheres] += along * n.x * n.y,
        block[2 * spheres] += along * n.x * n.z;
    block[3 * spheres] += along * n.y * n.y + across, block[4 * spheres] += along * n.y * n.z;
    block[5 * spheres] += along * n.z * n.z + across;
  }
}

void BallContact::undo_linearise(elements::Coordinates& force, elements::DiagonalBlocks& blocks) const {
  const std::size_t spheres = model_.sphere_count();
  for (const SphereContact& contact : contacts_) {
    const auto i = std::size_t(contact.sphere);
    for (std::size_t k = 0; k < 3; ++k) force[k * spheres + i] = contact.without[k];
    for (std::size_t k = 0; k < 6; ++k) blocks[k * spheres + i] = contact.without[3 + k];
  }
}

Vec3 BallContact::push_apart(double h, const Pin& pin, const Vec3Array& before, Vec3Array& velocity) {
  const double k = model_.contact_k, stick = model_.contact_friction > 0 ? model_.contact_stick_time * k : 0.0;
  std::vector<double>* const axes[3] = {&velocity.x, &velocity.y, &velocity.z};
  Vec3 on_ball;
  std::erase_if(contacts_, [&](const SphereContact& contact) {
    const auto i = std::size_t(contact.sphere);
    const double mass = model_.mass[i], damping = contact.damping;
    const ContactShares share(h * h * k / mass, h * damping / mass);
    const Vec3 n = contact.normal, change = velocity[i] - before[i];
    const double old = -contact.approach, free = mass * (old + dot(n, change));
    const double push = k * (contact.penetration + h * share.before * old) - damping * share.damped_before * old;
    const double along = (free + h * push) / (mass + h * (h * k * share.after + damping * share.damped_after));
    const double pressure = (mass * along - free) / h;
    if (pressure < 0) return true;
    const Vec3 across = mass * (contact.slip + change - dot(n, change) * n);
    const double limit = model_.contact_friction * k * contact.penetration, size = norm(across);
    const bool sticks = stick * size <= (mass + h * stick) * limit;
    const Vec3 acting = pressure * n - (sticks ? stick / (mass + h * stick) : limit / size) * across;
    const double kick[3] = {acting.x, acting.y, acting.z};
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((pin.held_axes(model_, i) >> axis & 1) == 0) (*axes[axis])[i] += h / mass * kick[axis];
    on_ball -= acting;
    return false;
  });
  return on_ball;
}

template <class Real>
double BallContact::apply(double h, const Real* v, Real* result) const {
  const std::size_t spheres = model_.sphere_count();
  double energy = 0;
  for (const SphereContact& contact : contacts_) {
    const auto i = std::size_t(contact.sphere);
    const Vec3 n = contact.normal, u{v[i], v[spheres + i], v[2 * spheres + i]};
    const double across = h * contact.drag, along = coupling_along(contact, h) - across;
    const Vec3 q = along * dot(n, u) * n + across * u;
    result[i] += Real(q.x), result[spheres + i] += Real(q.y), result[2 * spheres + i] += Real(q.z);
    energy += dot(u, q);
  }
  return energy;
}
template double BallContact::apply(double h, const float* v, float* result) const;
template double BallContact::apply(double h, const double* v, double* result) const;

Vec3 BallContact::change_of(const SphereContact& contact, const elements::Coordinates& v) const {
  const std::size_t spheres = model_.sphere_count(), i = std::size_t(contact.sphere);
  return {v[i], v[spheres + i], v[2 * spheres + i]};
}

/// Factor of the normal velocity in the matrix of a step of `h` [kg].
double BallContact::coupling_along(const SphereContact& contact, double h) const {
  return h * (h * model_.contact_k + contact.damping);
}

double BallContact::pressure(const SphereContact& contact, double h, const elements::Coordinates& v) const {
  return model_.contact_k * contact.penetration + contact.damping * contact.approach -
         coupling_along(contact, h) / h * dot(contact.normal, change_of(contact, v));
}

bool BallContact::has_pulling(double h, const elements::Coordinates& v) const {
  return std::any_of(contacts_.begin(), contacts_.end(),
                     [&](const SphereContact& contact) { return pressure(contact, h, v) < 0; });
}

void BallContact::drop_pulling(double h, const elements::Coordinates& v) {
  std::erase_if(contacts_, [&](const SphereContact& contact) { return pressure(contact, h, v) < 0; });
}

Vec3 BallContact::force_on_tool(double h, const elements::Coordinates& v) const {
  Vec3 force;
  for (const SphereContact& contact : contacts_) {
    const Vec3 n = contact.normal, change = change_of(contact, v), slip = contact.slip + change - dot(change, n) * n;
    force += contact.drag * slip - std::max(pressure(contact, h, v), 0.0) * n;
  }
  return force;
}

double BallContact::depth(const Vec3Array& position) const {
  double depth = 0;
  for (const SphereContact& contact : contacts_) {
    const auto i = std::size_t(contact.sphere);
    depth = std::max(depth, dot(contact.normal, position[i] - model_.rest_position[i]));
  }
  return depth;
}

}  // namespace ctpm::contact
