#include "tests/core/bench/network_ode.h"

#include <algorithm>
#include <cmath>

#include "core/contact/ball_contact.h"
#include "core/contact/contact_law.h"
#include "core/stepping/external_loads.h"

namespace ctpm::testing {

namespace {

constexpr double kPi = 3.14159265358979323846;

struct SphereContact {
  std::size_t sphere;
  Vec3 normal;         ///< from the ball to the sphere
  double penetration;  ///< [m]
  double damping;      ///< [N s/m]
  double approach;     ///< speed along the normal [m/s]
};

}  // namespace

Vec3 Press::centre(double time) const {
  const double wave = std::sin(kPi * time / duration);
  return touch - Vec3{0, 0, depth * wave * wave};
}

Vec3 Press::velocity(double time) const {
  return {0, 0, -depth * kPi / duration * std::sin(2 * kPi * time / duration)};
}

NetworkOde::NetworkOde(const Model& model, const State& start, const Press& press)
    : model_(model),
      start_(start),
      press_(press),
      spheres_(model.sphere_count()),
      team_(1),
      elements_(model, team_),
      state_(start),
      force_(3 * spheres_),
      blocks_(6 * spheres_),
      factor_(6 * spheres_) {}

std::vector<double> NetworkOde::start_values() const {
  std::vector<double> y(3 * spheres_);
  for (const auto* axis : {&start_.velocity.x, &start_.velocity.y, &start_.velocity.z})
    y.insert(y.end(), axis->begin(), axis->end());
  y.insert(y.end(), start_.kelvin_elongation.begin(), start_.kelvin_elongation.end());
  return y;
}

std::vector<double> NetworkOde::scales() const {
  std::vector<double> scale(size(), press_.depth);
  std::fill_n(scale.begin() + std::ptrdiff_t(3 * spheres_), 3 * spheres_, press_.depth / press_.duration);
  return scale;
}

void NetworkOde::take_state(const double* y) {
  std::vector<double>* position[3] = {&state_.position.x, &state_.position.y, &state_.position.z};
  std::vector<double>* velocity[3] = {&state_.velocity.x, &state_.velocity.y, &state_.velocity.z};
  const std::vector<double>* start[3] = {&start_.position.x, &start_.position.y, &start_.position.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double *u = y + axis * spheres_, *v = u + 3 * spheres_;
    for (std::size_t i = 0; i < spheres_; ++i) (*position[axis])[i] = (*start[axis])[i] + u[i];
    std::copy_n(v, spheres_, velocity[axis]->begin());
  }
  std::copy_n(y + 6 * spheres_, state_.kelvin_elongation.size(), state_.kelvin_elongation.begin());
}

void NetworkOde::add_loads(double time) {
  const Loads& loads = model_.loads;
  for (std::size_t l = 0; l < loads.size(); ++l) {
    const Vec3 pull = std::clamp((time - loads.start[l]) / loads.ramp[l], 0.0, 1.0) * loads.force[l];
    const auto i = std::size_t(loads.sphere[l]);
    force_[i] += pull.x, force_[spheres_ + i] += pull.y, force_[2 * spheres_ + i] += pull.z;
  }
}

/// Calls touch(contact) for every sphere that the ball overlaps. Without friction: a grip is no state of an equation.
template <class Touch>
void NetworkOde::for_each_touched(double time, Touch&& touch) const {
  if (press_.radius == 0) return;
  const Vec3 centre = press_.centre(time), velocity = press_.velocity(time);
  for (std::size_t i = 0; i < spheres_; ++i) {
    const Vec3 apart = state_.position[i] - centre;
    const double reach = press_.radius + model_.contact_radius[i], squared = dot(apart, apart);
    if (model_.held_axes[i] == kAnchored || squared >= reach * reach) continue;
    const double distance = std::sqrt(squared), penetration = reach - distance;
    const Vec3 normal = apart / distance, past = state_.velocity[i] - velocity;
    const double damping =
        contact::contact_damping(model_.contact_damping, model_.contact_k, model_.mass[i], penetration);
    touch(SphereContact{i, normal, penetration, damping, -dot(past, normal)});
  }
}

void NetworkOde::derive(double time, const double* y, double* derivative) {
  take_state(y);
  stepping::ExternalLoads{model_, time, false}.set(0, spheres_, force_);
  elements_.add_forces(state_, force_);
  add_loads(time);
  for_each_touched(time, [&](const SphereContact& contact) {
    const double pressure = model_.contact_k * contact.penetration + contact.damping * contact.approach;
    const Vec3 push = std::max(0.0, pressure) * contact.normal;
    const std::size_t i = contact.sphere;
    force_[i] += push.x, force_[spheres_ + i] += push.y, force_[2 * spheres_ + i] += push.z;
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double* v = y + (3 + axis) * spheres_;
    double *way = derivative + axis * spheres_, *speed = way + 3 * spheres_;
    for (std::size_t i = 0; i < spheres_; ++i) {
      const bool is_held = (model_.held_axes[i] >> axis & 1) != 0;
      way[i] = is_held ? 0.0 : v[i], speed[i] = is_held ? 0.0 : force_[axis * spheres_ + i] / model_.mass[i];
    }
  }
  const AxialElements& axial = model_.axial;
  const std::size_t tpms = axial.internal_count(), first = axial.size() - tpms;
  for (std::size_t t = 0; t < tpms; ++t) {
    const std::size_t i = first + t;
    const Vec3 apart = state_.position[std::size_t(axial.b[i])] - state_.position[std::size_t(axial.a[i])];
    const double x = norm(apart) - axial.rest_length[i], z = state_.kelvin_elongation[t];
    derivative[6 * spheres_ + t] = (axial.k[i] * (x - z) - axial.kelvin_k[i] * z) / axial.c[i];
  }
}

void NetworkOde::take_blocks(double time, double gamma, const double* y) {
  take_state(y);
  for (std::size_t k = 0; k < 6; ++k)
    for (std::size_t i = 0; i < spheres_; ++i)
      blocks_[k * spheres_ + i] = k == 0 || k == 3 || k == 5 ? model_.mass[i] : 0.0;
  elements_.linearise(state_, gamma, false, force_, blocks_, [](int) {});
  for_each_touched(time, [&](const SphereContact& contact) {
    const Vec3 n = contact.normal;
    const double along = gamma * (gamma * model_.contact_k + contact.damping);
    const double own[6] = {along * n.x * n.x, along * n.x * n.y, along * n.x * n.z,
                           along * n.y * n.y, along * n.y * n.z, along * n.z * n.z};
    for (std::size_t k = 0; k < 6; ++k) blocks_[k * spheres_ + contact.sphere] += own[k];
  });
  elements::kernels_for(elements::best_instruction_set())
      .full.factor_blocks(spheres_, blocks_.data(), factor_.data(), 0, spheres_);
}

void NetworkOde::precondition(double gamma, const double* r, double* z) const {
  const std::size_t n = spheres_;
  const double* b = factor_.data();
  for (std::size_t i = 0; i < n; ++i) {
    const double m = model_.mass[i], x = m * r[3 * n + i], y = m * r[4 * n + i], w = m * r[5 * n + i];
    const double lxy = b[n + i], lxz = b[2 * n + i], lyz = b[4 * n + i], u = y - lxy * x;
    z[5 * n + i] = b[5 * n + i] * (w - lxz * x - lyz * u);
    z[4 * n + i] = b[3 * n + i] * u - lyz * z[5 * n + i];
    z[3 * n + i] = b[i] * x - lxy * z[4 * n + i] - lxz * z[5 * n + i];
    for (std::size_t k = 0; k < 3; ++k) {
      if ((model_.held_axes[i] >> k & 1) != 0) z[(3 + k) * n + i] = r[(3 + k) * n + i];
      z[k * n + i] = r[k * n + i] + gamma * z[(3 + k) * n + i];
    }
  }
  const AxialElements& axial = model_.axial;
  const std::size_t tpms = axial.internal_count(), first = axial.size() - tpms;
  for (std::size_t t = 0; t < tpms; ++t)
    z[6 * n + t] = r[6 * n + t] / (1 + gamma * (axial.k[first + t] + axial.kelvin_k[first + t]) / axial.c[first + t]);
}

}  // namespace ctpm::testing
