// What a blade feels.

#include "core/blade_force.h"

#include "core/forces.h"
#include "tests/core/blade_blocks.h"

namespace ctpm {
namespace {

using testing::blade_at;
using testing::block_with_blade;
using testing::cut_through;
using testing::free_block;
using testing::held_block;
using testing::kinetic_energy;
using testing::kFriction;
using testing::kToughness;
using testing::make_block;
using testing::momentum;
using testing::resisting;
using testing::Work;

TEST(BladeForce, EveryPlaneOpensItsOwnAreaWhicheverWayItLies) {
  for (const LatticeKind lattice : {LatticeKind::cubic_18, LatticeKind::cubic_6}) {
    OrganSettings settings;
    settings.material = resisting(), settings.lattice = lattice;
    Model model;
    const FilledOrgan block = make_block(7, 7, 7);
    ASSERT_TRUE(add_organ(model, block, settings));
    const std::int32_t middle = 3 + 7 * (3 + 7 * 3);
    testing::Noise noise;
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 wild = noise.next_vec3(), n = wild / norm(wild);
      double opened = 0;  // energy per area of a plane with the normal n, from the elements of one sphere
      const auto add = [&](const auto& elements, const std::vector<double>& energy) {
        for (std::size_t e = 0; e < elements.size(); ++e) {
          if (elements.a[e] != middle && elements.b[e] != middle) continue;
          const Vec3 d = model.rest_position[std::size_t(elements.b[e])] -
                         model.rest_position[std::size_t(elements.a[e])];
          // Each direction leaves a sphere twice, and a volume s^3 has one element of each.
          opened += 0.5 * energy[e] * std::abs(dot(n, d)) / norm(d) * std::abs(dot(n, d)) /
                    std::pow(block.spacing, 3);
        }
      };
      add(model.edges, model.cut_resistance.edge_energy);
      add(model.tpms, model.cut_resistance.tpm_energy);
      EXPECT_NEAR(opened, kToughness, 1e-9 * kToughness);
    }
  }
}

TEST(BladeForce, TheHandsWorkIsTheToughnessTimesTheAreaAtEverySpeed) {
  const Model model = held_block(6, 5, 4);
  for (const double per_tick : {2e-5, 1e-4, 1e-3, 0.02, 0.11})
    for (const Vec3 way : {Vec3{0, 0.12, 0}, Vec3{0.03, 0.12, 0}}) {
      const Work work = cut_through(model, per_tick, {-0.0131 * way.x / 0.03 + 0.0002, -0.06, -0.05}, way);
      ASSERT_GT(work.of_fracture, 0);
      // The first half millimetre in which the heading is not yet known is outside; rounding is left.
      EXPECT_NEAR(work.by_hand, work.of_fracture, 1e-6 * work.of_fracture)
          << per_tick * 1e3 << " mm a tick along " << way.x;
    }
}

TEST(BladeForce, RisesBeforeTheCutAndIsGoneAfterIt) {
  const Model model = block_with_blade(6, 5, 4, resisting());
  Stepper stepper(model);
  State state = rest_state(model);
  double before_first = 0, while_cutting = 0;
  int severed = 0;
  StepReport report;
  for (int i = 0; i < 2400; ++i) {
    report = stepper.step(state, blade_at({0.0002, -0.06 + 5e-5 * i, -0.05}));
    ASSERT_EQ(report.status, StepStatus::ok);
    severed += report.severed;
    const double force = norm(report.tool_force);
    if (i < 300) { EXPECT_EQ(force, 0) << "far from the block, tick " << i; }
    if (severed == 0) before_first = std::max(before_first, force);
    if (severed > 0) while_cutting = std::max(while_cutting, force);
  }
  EXPECT_GT(severed, 0);
  EXPECT_GT(before_first, 0.5);
  // J_c times the height of the block is the mean force of a blade that cuts it.
  const double steady = kToughness * 0.048;
  EXPECT_GT(while_cutting, 0.7 * steady);
  EXPECT_LT(while_cutting, 4 * steady);
  EXPECT_EQ(norm(report.tool_force), 0) << "the blade has left";
}

TEST(BladeForce, ARestingBladeGoesOnHoldingTheTissueBack) {
  const Model model = block_with_blade(6, 5, 4, resisting());
  Stepper stepper(model);
  State state = rest_state(model);
  StepReport report;
  double y = -0.06;
  for (; y < 0 && report.tool_force.y > -1; y += 5e-5) report = stepper.step(state, blade_at({0.0002, y, -0.05}));
  ASSERT_LT(y, 0);
  for (int i = 0; i < 50; ++i) {
    // The hand trembles by 20 micrometres and the force does not jump.
    const double before = report.tool_force.y;
    report = stepper.step(state, blade_at({0.0002, y + (i % 2 ? 2e-5 : 0.0), -0.05}));
    EXPECT_LT(report.tool_force.y, -0.3);
    if (i > 0) { EXPECT_NEAR(report.tool_force.y, before, 0.15 * std::abs(before)) << i; }
  }
}

TEST(BladeForce, FlanksRubUntilTheBladeLeaves) {
  const Model model = held_block(6, 5, 4, resisting(0, kFriction));
  Stepper stepper(model);
  State state = rest_state(model);
  double most = 0;
  StepReport report;
  for (int i = 0; i < 1200; ++i) {
    report = stepper.step(state, blade_at({0.0002, -0.06 + 1e-4 * i, -0.05}));
    EXPECT_LE(report.tool_force.y, 0);
    most = std::max(most, -report.tool_force.y);
  }
  // Two flanks, 6 mm high, along the 48 mm of the blade that are inside.
  const double expected = 2 * kFriction * 0.006 * 0.048;
  EXPECT_GT(most, 0.5 * expected);
  EXPECT_LT(most, 2 * expected);
  EXPECT_EQ(norm(report.tool_force), 0);
}

TEST(BladeForce, TheTissueFeelsWhatTheHandFeels) {
  const Model model = free_block(6, 5, 4, resisting(kToughness, kFriction));
  Stepper stepper(model);
  State state = rest_state(model);
  Vec3 before;
  double largest = 0;
  for (const double per_tick : {1e-4, 4e-3})
    for (int i = 0; i < 300; ++i) {
      const Vec3 middle = state.position[70];
      const StepReport report = stepper.step(
          state, blade_at({0.0002 + 1e-5 * i, middle.y - 0.04 + per_tick * (i % 25), -0.05}));
      const Vec3 now = momentum(model, state), gained = now - before;
      EXPECT_NEAR(norm(gained + model.tick * report.tool_force), 0, 1e-9 + 1e-5 * norm(gained)) << i;
      largest = std::max(largest, norm(report.tool_force));
      before = now;
    }
  EXPECT_GT(largest, 1);
}

TEST(BladeForce, TissueNeverGainsMoreEnergyThanTheHandGives) {
  for (const double per_tick : {1e-4, 2e-3, 0.03}) {
    const Model model = free_block(6, 5, 4, resisting(kToughness, kFriction));
    Stepper stepper(model);
    State state = rest_state(model);
    double given = 0;
    const int ticks = int(0.12 / per_tick);
    for (int i = 0; i <= ticks + 50; ++i) {
      const int moved = std::min(i, ticks);
      const StepReport report = stepper.step(state, blade_at({0.0002, -0.06 + per_tick * moved, -0.05}));
      if (i > 0 && i <= ticks) given -= per_tick * report.tool_force.y;
      EXPECT_LE(elastic_energy(model, state) + kinetic_energy(model, state), given + 1e-9) << "tick " << i;
    }
    EXPECT_GT(given, 0);
  }
}

}  // namespace
}  // namespace ctpm
