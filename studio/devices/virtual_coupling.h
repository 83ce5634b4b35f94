#pragma once

#include "core/model/vec3.h"
#include "studio/devices/device.h"

namespace ctpm::devices {

struct CouplingSettings {
  double stiffness = 1000;  ///< of the spring between hand and tool [N/m], > 0
  double mass = 0.05;       ///< of the tool's stand-in [kg], > 0: high enough to be steady on stiff tissue
  double most_force = 20;   ///< with which the spring pulls the tool [N], > 0
  double turn_time = 5e-3;  ///< in which the tool follows a turn of the hand [s], > 0
  double most_turn = 10;    ///< speed at which it turns at most [rad/s], > 0
};

/// A spring and a damper between the hand and the tool, after Colgate, Stanley & Brown, "Issues in the haptic display
/// of tool use" (1995). The tool is a mass at the end of the spring that also feels the tissue; where it goes is what
/// enters the simulation and is recorded. A hand that jumps pulls the tool after it with a bounded force.
class VirtualCoupling {
 public:
  /// `tick` [s], > 0.
  VirtualCoupling(const CouplingSettings& settings, double tick);

  /// Puts the tool into the hand, at rest.
  void reset(const Pose& hand);

  /// One tick: the hand is at `hand`, and the tissue pushed the tool with `tissue_force` [N] in the tick before.
  /// The spring is solved implicitly, so that it is steady at any stiffness.
  void step(const Pose& hand, Vec3 tissue_force);

  const Pose& tool() const { return tool_; }

  /// With which the coupling pulls the hand towards the tool [N].
  Vec3 hand_force() const { return -tool_force_; }

 private:
  CouplingSettings settings_;
  double tick_, damping_;
  Pose tool_;
  Vec3 velocity_, hand_;
  Vec3 tool_force_;
};

/// Keeps a force that is sent to a hand bounded and passive: an account holds the work that the hand has done against
/// the forces sent so far, and no force may take more out of it than there is. After Hannaford & Ryu, "Time-domain
/// passivity control of haptic interfaces" (2002); where they add damping afterwards, here the force is made smaller
/// beforehand. It holds for a hand whose change of way grows by less than half from one sample to the next; one that
/// turns quicker is ahead by one sample, and pays before it is pushed again.
class PassiveForce {
 public:
  /// `most_force` [N], > 0.
  explicit PassiveForce(double most_force) : most_force_(most_force) {}

  /// The hand was measured at `position` [m], and held the force given last until then: the force [N] that it gets
  /// now, `wanted` or less.
  Vec3 pass(Vec3 wanted, Vec3 position);

  /// The hand gets no force until it is measured again.
  void release() { sent_ = {}; }

  double account() const { return account_; }  ///< work of the hand that has not come back to it [J]

 private:
  static constexpr double kLoan = 1e-6;     ///< without it nothing could begin: 1 N over 1 um [J]
  static constexpr double kMoreTurn = 1.5;  ///< how much more a hand turns in its way than it did last

  double most_force_;
  bool has_position_ = false;
  Vec3 position_, way_, sent_;
  double account_ = 0;
};

}  // namespace ctpm::devices
