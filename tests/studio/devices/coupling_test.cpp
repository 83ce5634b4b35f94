// The spring between hand and tool: steady, bounded and passive, also against tissue that is far too stiff.

#include "studio/devices/virtual_coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/stepping/step.h"
#include "studio/sources/rotation.h"
#include "tests/core/blocks.h"

namespace ctpm {
namespace {

constexpr double kTick = 1e-3;    // [s]
constexpr double kMostForce = 3;  // [N]
constexpr double kLoan = 1e-6;    // with which PassiveForce begins [J]

/// A block of `stiffness` times the paper's liver under a ball.
Model block_of(double stiffness) {
  network::Material material = testing::liver_material();
  material.spring *= stiffness, material.kelvin *= stiffness, material.constraint *= stiffness;
  Model model = testing::make_block_model(3, 3, 3, network::Structure::ctpm, material);
  model.tools.push_back(testing::ball(0.01));
  return model;
}

/// Where a hand is after a time [s]; it ends where it begins.
struct Path {
  const char* name;
  double duration;
  std::function<Vec3(double)> at;
};

/// Smooth from 0 to 1 and back to 0, at rest at both ends.
double there_and_back(double share) { return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * share); }

std::vector<Path> closed_paths() {
  const Vec3 start{0, 0, 0.045};  // the ball hangs 7 mm over the uppermost spheres
  const auto down = [=](double depth) { return start - Vec3{0, 0, 0.007 + depth}; };
  const auto between = [=](Vec3 to, double s) { return start + there_and_back(s) * (to - start); };
  return {
      {"a slow press", 3, [=](double t) { return between(down(0.008), t / 3); }},
      {"a quick tap", 0.15, [=](double t) { return between(down(0.006), t / 0.15); }},
      {"a press with a tremor of 12 Hz", 2,
       [=](double t) {
         const double s = there_and_back(t / 2);
         return between(down(0.006), t / 2) + s * 0.002 * std::sin(2 * std::numbers::pi * 12 * t) * Vec3{0, 0, 1};
       }},
      {"a press with a shaking of 60 Hz", 1,
       [=](double t) {
         const double s = there_and_back(t);
         return between(down(0.006), t) + s * 0.0005 * std::sin(2 * std::numbers::pi * 60 * t) * Vec3{1, 0, 1};
       }},
      {"a stroke across", 2,
       [=](double t) {
         return between(down(0.005), t / 2) + 0.012 * std::sin(2 * std::numbers::pi * t / 2) * Vec3{1, 0.5, 0};
       }},
  };
}

struct Energy {
  double returned = 0;  ///< to the hand, less what it put in [J]
  double most_force = 0, lowest_account = 0;
  bool is_steady = true;
};

/// Leads the ball along the path; the hand gets what `passive` lets through of the coupling's force.
Energy lead(const Model& model, const Path& path, const devices::CouplingSettings& settings,
            devices::PassiveForce& passive) {
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  devices::VirtualCoupling coupling(settings, kTick);
  coupling.reset({path.at(0), {}});
  stepping::StepReport report;
  Energy energy;
  Vec3 held, hand = path.at(0);
  const std::int64_t moving = std::llround(path.duration / kTick);
  for (std::int64_t tick = 0; tick <= moving + 200; ++tick) {  // and a moment at rest at the end
    const Vec3 now = path.at(std::min(double(tick) * kTick, path.duration));
    energy.returned += dot(held, now - hand);
    hand = now;
    coupling.step({hand, {}}, report.tool_force);
    held = passive.pass(coupling.hand_force(), hand);
    energy.most_force = std::max(energy.most_force, norm(held));
    energy.lowest_account = std::min(energy.lowest_account, passive.account());
    Inputs inputs;
    inputs.tool = 0, inputs.position = coupling.tool().position;
    report = stepper.step(state, inputs);
    energy.is_steady = energy.is_steady && report.status == stepping::StepStatus::ok;
  }
  return energy;
}

TEST(VirtualCoupling, ReturnsNoMoreEnergyOverAClosedPathThanWasPutIn) {
  // Up to tissue a hundred times as stiff as liver, and a spring twenty times as stiff as it is by default.
  struct Case {
    double tissue, spring;
  };
  for (const Case c : {Case{1, 1000}, Case{100, 1000}, Case{100, 20000}}) {
    const Model model = block_of(c.tissue);
    for (const Path& path : closed_paths()) {
      devices::PassiveForce passive(kMostForce);
      devices::CouplingSettings settings;
      settings.stiffness = c.spring;
      const Energy energy = lead(model, path, settings, passive);
      SCOPED_TRACE(::testing::Message() << path.name << ", tissue x " << c.tissue << ", spring " << c.spring << " N/m");
      EXPECT_TRUE(energy.is_steady);
      EXPECT_LT(energy.returned, 0) << "J";
      EXPECT_GE(energy.lowest_account, -kLoan) << "J";
      EXPECT_LE(energy.most_force, kMostForce * (1 + 1e-12));
      EXPECT_GT(energy.most_force, 0.1);  // it was felt
    }
  }
}

/// A wall that gives back more than it takes: a spring that pushes harder on the way out.
Vec3 greedy_wall(Vec3 hand, Vec3 way) {
  const double inside = std::max(0.0, 0.04 - hand.z);
  return {0, 0, (way.z > 0 ? 600 : 300) * inside};
}

TEST(PassiveForce, TakesFromAWallThatGivesMoreThanItGotWhatIsTooMuch) {
  for (const Path& path : closed_paths()) {
    double returned[2] = {0, 0}, felt = 0;
    for (const bool is_kept : {false, true}) {
      devices::PassiveForce passive(100);
      Vec3 held, hand = path.at(0);
      for (double t = 0; t <= path.duration + kTick; t += kTick) {
        const Vec3 now = path.at(std::min(t, path.duration)), wanted = greedy_wall(now, now - hand);
        returned[is_kept] += dot(held, now - hand);
        held = is_kept ? passive.pass(wanted, now) : wanted;
        felt = std::max(felt, norm(held));
        hand = now;
      }
    }
    EXPECT_GT(returned[0], 100 * kLoan) << path.name;  // it does give more, unless it is kept from it
    EXPECT_LE(returned[1], kLoan) << path.name;
    EXPECT_GT(felt, 0.5) << path.name;
  }
}

TEST(PassiveForce, IsBoundedWhateverIsWanted) {
  devices::PassiveForce passive(kMostForce);
  testing::Noise noise;
  for (int i = 0; i < 100000; ++i)
    EXPECT_LE(norm(passive.pass(1e3 * noise.next() * noise.next_vec3(), 0.1 * noise.next_vec3())),
              kMostForce * (1 + 1e-12));
}

TEST(VirtualCoupling, AHandThatJumpsBy50MillimetresIsFollowedWithABoundedForce) {
  const Model model = block_of(10);
  for (const Vec3 jump : {Vec3{0, 0, -0.05}, Vec3{0.05, 0, 0}, Vec3{0, 0, 0.05}}) {
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    const devices::CouplingSettings settings;
    devices::VirtualCoupling coupling(settings, kTick);
    devices::PassiveForce passive(kMostForce);
    Vec3 hand{0, 0, 0.036};
    coupling.reset({hand, {}});
    stepping::StepReport report;
    double most_sent = 0, most_speed = 0, most_felt = 0;
    for (int tick = 0; tick < 1500; ++tick) {
      if (tick == 300) hand = hand + jump;
      const Vec3 before = coupling.tool().position;
      coupling.step({hand, {}}, report.tool_force);
      most_sent = std::max(most_sent, norm(passive.pass(coupling.hand_force(), hand)));
      most_speed = std::max(most_speed, norm(coupling.tool().position - before) / kTick);
      Inputs inputs;
      inputs.tool = 0, inputs.position = coupling.tool().position;
      report = stepper.step(state, inputs);
      ASSERT_EQ(report.status, stepping::StepStatus::ok);
      most_felt = std::max(most_felt, norm(report.tool_force));
    }
    EXPECT_LE(most_sent, kMostForce * (1 + 1e-12));
    // A mass that is pulled by most_force over the jump is no faster than this: m v^2 / 2 = F s.
    EXPECT_LT(most_speed, std::sqrt(2 * settings.most_force * 0.05 / settings.mass));
    EXPECT_LT(most_felt, 5 * settings.most_force);  // an impact of the mass comes on top of the spring
  }
}

TEST(VirtualCoupling, TheToolFollowsAFreeHandWithoutLaggingBehindAndStopsWithIt) {
  devices::VirtualCoupling coupling({}, kTick);
  coupling.reset({});
  Vec3 hand;
  for (int tick = 0; tick < 500; ++tick) {
    hand = hand + kTick * Vec3{0.1, 0, 0};  // 100 mm/s
    coupling.step({hand, {}}, {});
  }
  EXPECT_NEAR(norm(coupling.tool().position - hand), 0, 1e-5);
  EXPECT_LT(norm(coupling.hand_force()), 0.01);
  double overshoot = 0;
  for (int tick = 0; tick < 500; ++tick) {
    coupling.step({hand, {}}, {});
    overshoot = std::max(overshoot, coupling.tool().position.x - hand.x);
  }
  EXPECT_NEAR(norm(coupling.tool().position - hand), 0, 1e-9);
  EXPECT_LT(overshoot, 0.5e-3);
}

TEST(VirtualCoupling, ATurnIsFollowedAtABoundedSpeed) {
  const devices::CouplingSettings settings;
  devices::VirtualCoupling coupling(settings, kTick);
  coupling.reset({});
  const Quat turned{0, 0, 1, 0};  // half a turn at once
  for (int tick = 0; tick < 500; ++tick) {
    const Quat before = coupling.tool().orientation;
    coupling.step({{}, turned}, {});
    EXPECT_LE(sources::angle_between(before, coupling.tool().orientation), settings.most_turn * kTick + 1e-7);
    EXPECT_NEAR(sources::length_of(coupling.tool().orientation), 1, 1e-12);
  }
  EXPECT_NEAR(sources::angle_between(coupling.tool().orientation, turned), 0, 1e-6);
}

TEST(VirtualCoupling, AToolStaysAboveTheDepthAtWhichTheHandGivesWayWithoutTrembling) {
  // Tissue that bears no more than 8 N, as what a ball goes right through: only the depth can stop it.
  constexpr double kBears = 8, kTissueStiffness = 800;
  for (const double way : {0.04, 0.4}) {
    devices::CouplingSettings settings;
    settings.most_force = 15, settings.most_depth = 0.02;
    devices::VirtualCoupling coupling(settings, kTick);
    coupling.reset({{0, 0, 0.01}, {}});
    double depth = 0, deepest = 0, least_at_rest = 1, most_at_rest = 0;
    for (int tick = 0; tick < 3000; ++tick) {
      const Vec3 hand{0, 0, 0.01 - std::min(0.3 * tick * kTick, way)};
      coupling.step({hand, {}}, {0, 0, std::min(kBears, kTissueStiffness * depth)}, depth);
      depth = std::max(0.0, -coupling.tool().position.z);
      deepest = std::max(deepest, depth);
      if (tick > 2500) least_at_rest = std::min(least_at_rest, depth), most_at_rest = std::max(most_at_rest, depth);
    }
    EXPECT_GT(least_at_rest, settings.most_depth);
    EXPECT_LT(most_at_rest, settings.most_depth + 4e-3);
    EXPECT_LT(most_at_rest - least_at_rest, 1e-4) << "it trembles";
    EXPECT_LT(deepest, settings.most_depth + 5e-3) << "on its way there";
  }
}

TEST(VirtualCoupling, AStandingHandFeelsTheTissueAsItIs) {
  devices::VirtualCoupling coupling({}, kTick);
  coupling.reset({});
  for (int tick = 0; tick < 1000; ++tick) coupling.step({{}, {}}, {0, 0, 1.5});
  EXPECT_NEAR(norm(coupling.hand_force() - Vec3{0, 0, 1.5}), 0, 1e-9);
  EXPECT_NEAR(coupling.tool().position.z, 1.5 / devices::CouplingSettings().stiffness, 1e-9);
}

}  // namespace
}  // namespace ctpm
