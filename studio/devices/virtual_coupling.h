#pragma once

#include "core/model/vec3.h"
#include "studio/devices/device.h"

namespace ctpm::devices {

struct CouplingSettings {
  double stiffness = 1000;  ///< of the spring between hand and tool [N/m], > 0
  double mass = 0.05;       ///< virtual mass of the tool [kg], > 0: high enough for stability on stiff tissue
  double most_force = 20;   ///< largest force of the spring on the tool, at which the hand gives way [N], > 0
  double most_depth = 0;    ///< depth of the tool in tissue at which it gives way, too [m]; 0: none
  double turn_time = 5e-3;  ///< time constant with which the tool follows the hand's rotation [s], > 0
  double most_turn = 10;    ///< largest angular speed of the tool [rad/s], > 0
};

/// A spring and a damper between the hand and the tool, after Colgate, Stanley & Brown, "Issues in the haptic display
/// of tool use" (1995). The tool is a mass at the end of the spring, on which the tissue acts too. Its pose enters the
/// simulation and is recorded. If the hand jumps, the force on the tool stays bounded.
class VirtualCoupling {
 public:
  /// `tick` [s], > 0.
  VirtualCoupling(const CouplingSettings& settings, double tick);

  /// Puts the tool at the hand, at rest.
  void reset(const Pose& hand);

  /// Advances one tick: the hand is at `hand`; `tissue_force` [N] is the tissue's force on the tool in the tick before,
  /// `depth` [m] how deep the tool was. The spring is integrated implicitly, so that it is stable at any stiffness.
  void step(const Pose& hand, Vec3 tissue_force, double depth = 0);

  const Pose& tool() const { return tool_; }

  /// Force of the coupling on the hand, towards the tool [N].
  Vec3 hand_force() const { return -tool_force_; }

 private:
  /// Over which the largest force falls to zero behind most_depth [m]: a step would make the tool tremble there.
  static constexpr double kGivesWayOver = 4e-3;

  CouplingSettings settings_;
  double tick_, damping_;
  Pose tool_;
  Vec3 velocity_, hand_;
  Vec3 tool_force_;
};

/// Keeps the force that is sent to a hand bounded and passive. An energy account holds the work that the hand has done
/// against the forces sent so far; no force may return more energy than it holds. After Hannaford & Ryu, "Time-domain
/// passivity control of haptic interfaces" (2002). Deviation: they add damping afterwards; this reduces the force
/// beforehand. The bound holds if the change of the hand's displacement per sample grows by less than 50 % from one
/// sample to the next. A hand that turns quicker overdraws the account for one sample, and gets no driving force until
/// it has repaid.
class PassiveForce {
 public:
  /// `most_force` [N], > 0.
  explicit PassiveForce(double most_force) : most_force_(most_force) {}

  /// Returns the force [N] for the hand now: `wanted`, or less in the same direction. `position` [m] is the hand's
  /// measured position; the last force acted on it until now.
  Vec3 pass(Vec3 wanted, Vec3 position);

  /// No force acts on the hand until the next pass().
  void release() { sent_ = {}; }

  double account() const { return account_; }  ///< work of the hand that was not returned to it [J]

 private:
  static constexpr double kLoan = 1e-6;     ///< initial credit, without which no force could start: 1 N over 1 um [J]
  static constexpr double kMoreTurn = 1.5;  ///< assumed growth of the change of displacement per sample

  double most_force_;
  bool has_position_ = false;
  Vec3 position_, way_, sent_;
  double account_ = 0;
};

}  // namespace ctpm::devices
