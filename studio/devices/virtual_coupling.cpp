#include "studio/devices/virtual_coupling.h"

#include <algorithm>
#include <cmath>

#include "studio/sources/rotation.h"

namespace ctpm::devices {

VirtualCoupling::VirtualCoupling(const CouplingSettings& settings, double tick)
    : settings_(settings), tick_(tick), damping_(2 * std::sqrt(settings.stiffness * settings.mass)) {}

void VirtualCoupling::reset(const Pose& hand) {
  tool_ = hand;
  hand_ = hand.position;
  velocity_ = {}, tool_force_ = {};
}

void VirtualCoupling::step(const Pose& hand, Vec3 tissue_force, double depth) {
  const Vec3 hand_velocity = (hand.position - hand_) / tick_, stretch = hand.position - tool_.position;
  hand_ = hand.position;

  // Above the largest force, stiffness and damping are reduced by the same factor.
  const double m = settings_.mass, h = tick_;
  const Vec3 pull = settings_.stiffness * stretch + damping_ * (hand_velocity - velocity_);
  // Beyond the largest depth the largest force falls, and a drag on the tool keeps it from trembling where both forces
  // meet.
  const double over = settings_.most_depth > 0 ? (depth - settings_.most_depth) / kGivesWayOver : 0;
  const double beyond = std::clamp(over, 0.0, 1.0), drag = beyond * damping_;
  const double most_force = settings_.most_force * (1 - beyond);
  const double share = std::min(1.0, most_force / std::max(norm(pull), 1e-300));
  const double k = share * settings_.stiffness, b = share * damping_;

  // m (v' - v) / h = k (stretch - h v') + b (hand_velocity - v') - drag v' + tissue_force
  const Vec3 v =
      (m * velocity_ + h * (k * stretch + b * hand_velocity + tissue_force)) / (m + h * (b + drag) + h * h * k);
  tool_force_ = k * (stretch - h * v) + b * (hand_velocity - v);
  velocity_ = v;
  tool_.position = tool_.position + h * v;

  const double angle = sources::angle_between(tool_.orientation, hand.orientation);
  const double turn = std::min(angle * h / (settings_.turn_time + h), settings_.most_turn * h);
  if (angle > 0) tool_.orientation = sources::turned_towards(tool_.orientation, hand.orientation, turn / angle);
}

Vec3 PassiveForce::pass(Vec3 wanted, Vec3 position) {
  const Vec3 way = has_position_ ? position - position_ : Vec3{}, turn = way - way_;
  account_ -= dot(sent_, way);
  position_ = position, way_ = way, has_position_ = true;

  const double size = norm(wanted);
  if (size > most_force_) wanted = most_force_ / size * wanted;
  // Largest work that the force can do on the hand until the next sample, if the displacement repeats and changes along
  // the force.
  const double taken = dot(wanted, way) + kMoreTurn * norm(wanted) * norm(turn);
  const double most = std::max(0.0, account_ + kLoan);
  if (taken > most) wanted = most / taken * wanted;
  sent_ = wanted;
  return wanted;
}

}  // namespace ctpm::devices
