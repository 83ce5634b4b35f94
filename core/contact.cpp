#include "core/contact.h"

#include <algorithm>
#include <cmath>

namespace ctpm {
namespace {

/// While surfaces stick, drag is contact_k times this [s]: a sphere under a resting tool creeps over seconds.
constexpr double kStickTime = 0.1;

/// Spheres whose distance is looked at together before each is looked at by itself.
constexpr std::size_t kLookedAtOnce = 128;

}  // namespace

BallContact::BallContact(const Model& model, const Kernels& kernels) : model_(model), kernels_(kernels) {
  const auto presses = [](const Tool& tool) { return tool.kind == ToolKind::ball; };
  if (std::any_of(model.tools.begin(), model.tools.end(), presses)) contacts_.reserve(model.sphere_count());
  for (const double radius : model.contact_radius) largest_radius_ = std::max(largest_radius_, radius);
}

void BallContact::find(const State& state, Vec3 centre, double radius, Vec3 velocity) {
  contacts_.clear();
  velocity_ = velocity;
  const double farthest = (radius + largest_radius_) * (radius + largest_radius_), at[3] = {centre.x, centre.y, centre.z};
  for (std::size_t begin = 0; begin < state.position.size(); begin += kLookedAtOnce) {
    const std::size_t end = std::min(begin + kLookedAtOnce, state.position.size());
    const double nearest = kernels_.nearest_squared(state.position.x.data(), state.position.y.data(),
                                                    state.position.z.data(), at, begin, end);
    if (nearest < farthest) find_among(state, centre, radius, begin, end);
  }
}

void BallContact::find_among(const State& state, Vec3 centre, double radius, std::size_t begin, std::size_t end) {
  const Vec3 velocity = velocity_;
  for (std::size_t i = begin; i < end; ++i) {
    if (model_.held_axes[i] == kAnchored) continue;
    const Vec3 apart = state.position[i] - centre;
    const double reach = radius + model_.contact_radius[i];
    const double distance_squared = dot(apart, apart);
    if (distance_squared >= reach * reach) continue;
    const double distance = std::sqrt(distance_squared);
    // A sphere whose centre the tool has reached is pushed the way the tool goes.
    const Vec3 fallback = norm(velocity) > 0 ? velocity / norm(velocity) : Vec3{0, 0, -1};
    const Vec3 normal = distance > 1e-9 * reach ? apart / distance : fallback;
    const double penetration = reach - distance;
    const Vec3 slip = state.velocity[i] - velocity;
    const double speed = norm(slip - dot(slip, normal) * normal);
    const double stick = kStickTime * model_.contact_k,
                 limit = model_.contact_friction * model_.contact_k * penetration;
    const double drag = model_.contact_friction > 0 ? (speed * stick > limit ? limit / speed : stick) : 0.0;
    contacts_.push_back({std::int32_t(i), normal, penetration, drag, {}});
  }
}

void BallContact::linearise(double h, Coordinates& force, DiagonalBlocks& blocks) {
  const std::size_t spheres = model_.sphere_count();
  for (Contact& contact : contacts_) {
    const auto i = std::size_t(contact.sphere);
    for (std::size_t k = 0; k < 3; ++k) contact.without[k] = force[k * spheres + i];
    for (std::size_t k = 0; k < 6; ++k) contact.without[3 + k] = blocks[k * spheres + i];
    const Vec3 n = contact.normal;
    const Vec3 push =
        model_.contact_k * contact.penetration * n + contact.drag * (velocity_ - dot(velocity_, n) * n);
    force[i] += push.x, force[spheres + i] += push.y, force[2 * spheres + i] += push.z;
    const double across = h * contact.drag, along = h * h * model_.contact_k - across;
    double* block = &blocks[i];
    block[0] += along * n.x * n.x + across, block[spheres] += along * n.x * n.y,
        block[2 * spheres] += along * n.x * n.z;
    block[3 * spheres] += along * n.y * n.y + across, block[4 * spheres] += along * n.y * n.z;
    block[5 * spheres] += along * n.z * n.z + across;
  }
}

void BallContact::undo_linearise(Coordinates& force, DiagonalBlocks& blocks) const {
  const std::size_t spheres = model_.sphere_count();
  for (const Contact& contact : contacts_) {
    const auto i = std::size_t(contact.sphere);
    for (std::size_t k = 0; k < 3; ++k) force[k * spheres + i] = contact.without[k];
    for (std::size_t k = 0; k < 6; ++k) blocks[k * spheres + i] = contact.without[3 + k];
  }
}

void BallContact::push_apart(double h, Coordinates& velocity) {
  const std::size_t spheres = model_.sphere_count();
  std::erase_if(contacts_, [&](const Contact& contact) {
    const auto i = std::size_t(contact.sphere);
    const double mass = model_.mass[i], k = model_.contact_k;
    const Vec3 n = contact.normal, free = mass * Vec3{velocity[i], velocity[spheres + i], velocity[2 * spheres + i]};
    const double along = (dot(n, free) + h * k * contact.penetration) / (mass + h * h * k);
    if (contact.penetration < h * along) return true;
    const Vec3 across = (free - dot(n, free) * n + h * contact.drag * (velocity_ - dot(velocity_, n) * n)) /
                        (mass + h * contact.drag);
    const Vec3 pushed = along * n + across;
    velocity[i] = pushed.x, velocity[spheres + i] = pushed.y, velocity[2 * spheres + i] = pushed.z;
    return false;
  });
}

template <class Real>
double BallContact::apply(double h, const Real* v, Real* result) const {
  const std::size_t spheres = model_.sphere_count();
  double energy = 0;
  for (const Contact& contact : contacts_) {
    const auto i = std::size_t(contact.sphere);
    const Vec3 n = contact.normal, u{v[i], v[spheres + i], v[2 * spheres + i]};
    const double across = h * contact.drag, along = h * h * model_.contact_k - across;
    const Vec3 q = along * dot(n, u) * n + across * u;
    result[i] += Real(q.x), result[spheres + i] += Real(q.y), result[2 * spheres + i] += Real(q.z);
    energy += dot(u, q);
  }
  return energy;
}
template double BallContact::apply(double h, const float* v, float* result) const;
template double BallContact::apply(double h, const double* v, double* result) const;

Vec3 BallContact::relative_velocity(const Contact& contact, const Coordinates& v) const {
  const std::size_t spheres = model_.sphere_count(), i = std::size_t(contact.sphere);
  return Vec3{v[i], v[spheres + i], v[2 * spheres + i]} - velocity_;
}

double BallContact::pressure(const Contact& contact, double h, const Coordinates& v) const {
  const Vec3 absolute = relative_velocity(contact, v) + velocity_;
  return model_.contact_k * (contact.penetration - h * dot(contact.normal, absolute));
}

bool BallContact::has_pulling(double h, const Coordinates& v) const {
  return std::any_of(contacts_.begin(), contacts_.end(),
                     [&](const Contact& contact) { return pressure(contact, h, v) < 0; });
}

void BallContact::drop_pulling(double h, const Coordinates& v) {
  std::erase_if(contacts_, [&](const Contact& contact) { return pressure(contact, h, v) < 0; });
}

Vec3 BallContact::force_on_tool(double h, const Coordinates& v) const {
  Vec3 force;
  for (const Contact& contact : contacts_) {
    const Vec3 n = contact.normal, slip = relative_velocity(contact, v);
    force += contact.drag * (slip - dot(slip, n) * n) - std::max(pressure(contact, h, v), 0.0) * n;
  }
  return force;
}

double BallContact::depth(const State& state) const {
  double depth = 0;
  for (const Contact& contact : contacts_) {
    const auto i = std::size_t(contact.sphere);
    depth = std::max(depth, dot(contact.normal, state.position[i] - model_.rest_position[i]));
  }
  return depth;
}

}  // namespace ctpm
