// Forces on a blade.

#include "core/contact/blade_force.h"

#include "core/elements/forces.h"
#include "tests/core/blade_blocks.h"

namespace ctpm {
namespace {

using testing::blade_at;
using testing::block_with_blade;
using testing::cut_through;
using testing::free_block;
using testing::held_block;
using testing::kFriction;
using testing::kinetic_energy;
using testing::kToughness;
using testing::make_block;
using testing::momentum;
using testing::resisting;
using testing::Work;

TEST(BladeForce, EveryPlaneOpensItsOwnAreaWhicheverWayItLies) {
  for (const network::LatticeKind lattice : {network::LatticeKind::cubic_18, network::LatticeKind::cubic_6}) {
    network::OrganSettings settings;
    settings.material = resisting(), settings.lattice = lattice;
    Model model;
    const FilledOrgan block = make_block(7, 7, 7);
    ASSERT_TRUE(network::add_organ(model, block, settings));
    const std::int32_t middle = 3 + 7 * (3 + 7 * 3);
    testing::Noise noise;
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 wild = noise.next_vec3(), n = wild / norm(wild);
      double opened = 0;  // energy per area of a plane with the normal n, from the elements of one sphere
      const AxialElements& axial = model.axial;
      for (std::size_t e = 0; e < axial.size(); ++e) {
        if (axial.a[e] != middle && axial.b[e] != middle) continue;
        const Vec3 d = model.rest_position[std::size_t(axial.b[e])] - model.rest_position[std::size_t(axial.a[e])];
        // A sphere has two elements of each direction; a volume s^3 has one.
        opened += 0.5 * model.cut_resistance.energy[e] * std::abs(dot(n, d)) / norm(d) * std::abs(dot(n, d)) /
                  std::pow(block.spacing, 3);
      }
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
      // The heading is unknown for the first half millimetre, but that lies outside the block. Only rounding errors
      // remain.
      EXPECT_NEAR(work.by_hand, work.of_fracture, 1e-6 * work.of_fracture)
          << per_tick * 1e3 << " mm a tick along " << way.x;
    }
}

/// A block of 60 x 60 x 36 mm, held at the bottom and at both sides, that a blade cuts in half.
Model clamped_block(double spacing, const network::Material& material) {
  const int f = int(std::lround(0.012 / spacing));
  Model model = testing::make_block_model(5 * f, 5 * f, 3 * f, network::Structure::ctpm, material, spacing);
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (int(i) % (5 * f) == 0 || int(i) % (5 * f) == 5 * f - 1) model.held_axes[i] = kAnchored;
  model.tools = {testing::scalpel(0.2)};
  return model;
}

/// Energy that Kelvin units dissipate in a tick [J].
double viscous_work(const Model& model, const State& before, const State& after) {
  double work = 0;
  const AxialElements& axial = model.axial;
  for (std::size_t e = 0; e < axial.size(); ++e) {
    if (after.axial_severed[e]) continue;
    const auto a = std::size_t(axial.a[e]), b = std::size_t(axial.b[e]);
    const Vec3 d = before.position[b] - before.position[a];
    double rate = dot(after.velocity[b] - after.velocity[a], d) / norm(d);
    if (axial.law[e] == AxialLaw::two_sphere_tpm) {
      const auto t = std::size_t(axial.internal[e]);
      rate = (after.kelvin_elongation[t] - before.kelvin_elongation[t]) / model.tick;
    }
    work += model.tick * axial.c[e] * rate * rate;
  }
  return work;
}

TEST(BladeForce, TheHandPaysForTheAreaAndForWhatTheTissueLosesWhateverTheSpheres) {
  constexpr double kPerTick = 4e-5;
  for (const double spacing : {0.012, 0.006}) {
    // Stiff, so that the blade hardly drags the tissue and meets the elements in their rest directions.
    network::Material material = resisting();
    material.stiffness_scale = 3;
    const Model model = clamped_block(spacing, material);
    stepping::Stepper stepper(model);
    State state = rest_state(model), before = state;
    double by_hand = 0, lost = 0;
    for (int i = 0; i <= int(0.1 / kPerTick); ++i) {
      before = state;
      const stepping::StepReport report = stepper.step(state, blade_at({0.0002, -0.05 + kPerTick * i, -0.05}));
      if (i > 0) by_hand -= kPerTick * report.tool_force.y;
      lost += viscous_work(model, before, state);
    }
    const double opened = testing::fracture_energy(model, state, {1, 0, 0});
    EXPECT_NEAR(opened, kToughness * 0.06 * 0.036, 0.25 * opened) << "spheres at the rim have fewer elements";
    EXPECT_NEAR(by_hand, opened + lost, 0.06 * opened) << spacing;
    EXPECT_LT(by_hand, 1.2 * opened) << spacing;
  }
}

TEST(BladeForce, RisesBeforeTheCutAndIsGoneAfterIt) {
  const Model model = block_with_blade(6, 5, 4, resisting());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  double before_first = 0, while_cutting = 0;
  int severed = 0;
  stepping::StepReport report;
  for (int i = 0; i < 2400; ++i) {
    report = stepper.step(state, blade_at({0.0002, -0.06 + 5e-5 * i, -0.05}));
    ASSERT_EQ(report.status, stepping::StepStatus::ok);
    severed += report.severed;
    const double force = norm(report.tool_force);
    if (i < 300) {
      EXPECT_EQ(force, 0) << "far from the block, tick " << i;
    }
    if (severed == 0) before_first = std::max(before_first, force);
    if (severed > 0) while_cutting = std::max(while_cutting, force);
  }
  EXPECT_GT(severed, 0);
  EXPECT_GT(before_first, 0.5);
  // The mean cutting force is J_c times the height of the block.
  const double steady = kToughness * 0.048;
  EXPECT_GT(while_cutting, 0.7 * steady);
  EXPECT_LT(while_cutting, 4 * steady);
  EXPECT_EQ(norm(report.tool_force), 0) << "the blade has left";
}

TEST(BladeForce, ARestingBladeGoesOnHoldingTheTissueBack) {
  const Model model = block_with_blade(6, 5, 4, resisting());
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  stepping::StepReport report;
  double y = -0.06;
  for (; y < 0 && report.tool_force.y > -1; y += 5e-5) report = stepper.step(state, blade_at({0.0002, y, -0.05}));
  ASSERT_LT(y, 0);
  for (int i = 0; i < 50; ++i) {
    // The hand trembles by 20 micrometres; the force must not jump.
    const double before = report.tool_force.y;
    report = stepper.step(state, blade_at({0.0002, y + (i % 2 ? 2e-5 : 0.0), -0.05}));
    EXPECT_LT(report.tool_force.y, -0.3);
    if (i > 0) {
      EXPECT_NEAR(report.tool_force.y, before, 0.15 * std::abs(before)) << i;
    }
  }
}

TEST(BladeForce, FlanksRubUntilTheBladeLeavesWhateverTheSpheres) {
  for (const auto& [spacing, flank_height] : {std::pair{0.012, 0.006}, {0.006, 0.006}, {0.006, 0.009}}) {
    Model model = clamped_block(spacing, resisting(0, kFriction));
    model.held_axes.assign(model.sphere_count(), kAnchored);
    model.tools[0].flank_height = flank_height;
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    double sum = 0;
    int inside = 0;
    stepping::StepReport report;
    for (int i = 0; i < 1200; ++i) {
      const double y = -0.06 + 1e-4 * i;
      report = stepper.step(state, blade_at({0.0002, y, -0.05}));
      EXPECT_LE(report.tool_force.y, 0);
      if (std::abs(y) < 0.018) sum -= report.tool_force.y, ++inside;
    }
    // Two flanks along the 36 mm of blade inside the block; spheres at the boundary have fewer elements.
    const double expected = 2 * kFriction * flank_height * 0.036;
    EXPECT_LT(sum / inside, 1.05 * expected) << spacing;
    EXPECT_GT(sum / inside, 0.75 * expected) << spacing;
    EXPECT_EQ(norm(report.tool_force), 0);
  }
}

/// Force [N] on a blade halfway through a held block, at `per_tick` [m] per tick, after the right half of the block has
/// moved to the right by `opened` [m].
double friction_in_opened_cut(const Tool& blade, double opened, double per_tick) {
  Model model = held_block(6, 5, 4, resisting(0, kFriction));
  model.tools = {blade};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  double y = -0.06;
  for (; y < 0; y += 1e-3) (void)stepper.step(state, blade_at({0.0002, y, -0.05}));
  for (std::size_t i = 0; i < model.sphere_count(); ++i)
    if (state.position.x[i] > 0) state.position.x[i] += opened;
  (void)stepper.step(state, blade_at({0.0002, y, -0.05}));
  return -stepper.step(state, blade_at({0.0002, y + per_tick, -0.05})).tool_force.y;
}

TEST(BladeForce, CutFacesLeaveTheFlanksWhereTheyOpenWiderThanTheBlade) {
  Tool blade = testing::scalpel(0.2);
  const double closed = friction_in_opened_cut(blade, 0, 1e-3);
  EXPECT_GT(closed, 0.1);
  EXPECT_EQ(friction_in_opened_cut(blade, 0.003, 1e-3), 0) << "1 mm thick";
  blade.blade_thickness = 0.03;
  EXPECT_GT(friction_in_opened_cut(blade, 0.003, 1e-3), 0.8 * closed) << "30 mm thick";
}

TEST(BladeForce, FrictionFallsLinearlyBelowTheSlowestSlip) {
  Tool blade = testing::scalpel(0.2);
  const double full = friction_in_opened_cut(blade, 0, 1e-5);
  EXPECT_GT(full, 0.1);
  EXPECT_NEAR(friction_in_opened_cut(blade, 0, 2.5e-7), 0.25 * full, 0.01 * full) << "at 0.25 mm/s of 1 mm/s";
  blade.slowest_slip = 1e-4;
  EXPECT_NEAR(friction_in_opened_cut(blade, 0, 2.5e-7), full, 0.01 * full);
}

/// Position of the blade's tip when a held block first resists it [m].
double resistance_begins(const Tool& blade) {
  Model model = held_block(6, 5, 4);
  model.tools = {blade};
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  double y = -0.1;
  while (y < 0 && stepper.step(state, blade_at({0.0002, y, -0.05})).tool_force.y == 0) y += 1e-4;
  return y;
}

TEST(BladeForce, TissueResistsOverTheReachAheadOfTheEdge) {
  Tool blade = testing::scalpel(0.2);
  const double near = resistance_begins(blade);
  blade.blade_reach = 0.02;
  EXPECT_NEAR(near - resistance_begins(blade), 0.011, 2e-4);
  blade.blade_reach = 1e-3;
  EXPECT_NEAR(resistance_begins(blade), near, 2e-4) << "0.75 spacings of 12 mm are the least";
  blade.blade_reach_spacings = 0.25;
  EXPECT_NEAR(resistance_begins(blade) - near, 0.006, 2e-4);
}

TEST(BladeForce, GrowsWithTheHeadingUntilTheTrailIsTaut) {
  const auto force_after = [](double trail_distance, double way) {
    Model model = held_block(6, 5, 4);
    model.tools[0].trail_distance = trail_distance;
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    (void)stepper.step(state, blade_at({0.0002, -0.03, -0.05}));
    return norm(stepper.step(state, blade_at({0.0002, -0.03 + way, -0.05})).tool_force);
  };
  EXPECT_GT(force_after(0.5e-3, 1e-4), 0);
  EXPECT_NEAR(force_after(0.5e-3, 1e-4), 2 * force_after(1e-3, 1e-4), 1e-9);
  EXPECT_EQ(force_after(0.5e-3, 1e-3), force_after(1e-3, 1e-3)) << "both are taut";
}

TEST(BladeForce, SlicingAlongTheEdgeMakesPushingEasier) {
  // Atkins, Xu & Jeronimidis, "Cutting, by pressing and slicing", J. Mater. Sci. 39, 2004: with the
  // slice-push ratio xi the push falls to 1 / (1 + xi^2), and the slice is xi times that.
  Model model = clamped_block(0.006, resisting());
  model.held_axes.assign(model.sphere_count(), kAnchored);
  const auto mean_force = [&](double xi) {
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    Vec3 sum;
    int inside = 0;
    for (int i = 0; i < 600; ++i) {
      const double y = -0.05 + 1e-4 * i;
      const stepping::StepReport report = stepper.step(state, blade_at({0.0002, y, -0.1 + xi * (y + 0.05)}));
      if (std::abs(y) < 0.012) sum += report.tool_force, ++inside;
    }
    return sum / inside;
  };
  const double push = -mean_force(0).y;
  EXPECT_NEAR(push, kToughness * 0.036, 0.15 * push) << "spheres at the rim have fewer elements";
  for (const double xi : {0.5, 1.0}) {
    const Vec3 force = mean_force(xi);
    EXPECT_NEAR(-force.y, push / (1 + xi * xi), 0.03 * push) << xi;
    EXPECT_NEAR(-force.z, xi * push / (1 + xi * xi), 0.03 * push) << xi;
  }
}

TEST(BladeForce, WhatTensionHasStoredOpensTheCutWithTheHand) {
  const network::Material material = resisting();
  Model model = clamped_block(0.012, material);
  model.held_axes.assign(model.sphere_count(), kAnchored);
  State state = rest_state(model);
  for (double& x : state.position.x) x *= 1.3;  // stretched across the cut
  stepping::Stepper stepper(model);
  double by_hand = 0;
  for (int i = 0; i < 1000; ++i)
    by_hand -= 1e-4 * stepper.step(state, blade_at({0.0002, -0.05 + 1e-4 * i, -0.05})).tool_force.y;
  double opened = 0, stored = 0;
  const AxialElements& axial = model.axial;
  for (std::size_t e = 0; e < axial.size(); ++e) {
    if (!state.axial_severed[e]) continue;
    const Vec3 d = state.position[std::size_t(axial.b[e])] - state.position[std::size_t(axial.a[e])];
    const bool is_tpm = axial.law[e] == AxialLaw::two_sphere_tpm;
    const double k = is_tpm ? axial.k[e] * axial.kelvin_k[e] / (axial.k[e] + axial.kelvin_k[e]) : axial.k[e];
    const double stretch = std::max(0.0, norm(d) - axial.rest_length[e]);
    const double to_open = model.cut_resistance.energy[e] * std::abs(d.x) / norm(d);
    opened += to_open, stored += std::min(to_open, 0.5 * k * stretch * stretch);
  }
  EXPECT_GT(stored, 0.05 * opened);
  EXPECT_NEAR(by_hand, opened - stored, 1e-3 * opened) << "F ds = J_c dA - dE";
}

TEST(BladeForce, TheTissueFeelsWhatTheHandFeels) {
  const Model model = free_block(6, 5, 4, resisting(kToughness, kFriction));
  stepping::Stepper stepper(model);
  State state = rest_state(model);
  Vec3 before;
  double largest = 0;
  for (const double per_tick : {1e-4, 4e-3})
    for (int i = 0; i < 300; ++i) {
      const Vec3 middle = state.position[70];
      const stepping::StepReport report =
          stepper.step(state, blade_at({0.0002 + 1e-5 * i, middle.y - 0.04 + per_tick * (i % 25), -0.05}));
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
    stepping::Stepper stepper(model);
    State state = rest_state(model);
    double given = 0;
    const int ticks = int(0.12 / per_tick);
    for (int i = 0; i <= ticks + 50; ++i) {
      const int moved = std::min(i, ticks);
      const stepping::StepReport report = stepper.step(state, blade_at({0.0002, -0.06 + per_tick * moved, -0.05}));
      if (i > 0 && i <= ticks) given -= per_tick * report.tool_force.y;
      EXPECT_LE(elements::elastic_energy(model, state) + kinetic_energy(model, state), given + 1e-9) << "tick " << i;
    }
    EXPECT_GT(given, 0);
  }
}

}  // namespace
}  // namespace ctpm
